#!/usr/bin/python3
"""What public_abi.py lets pass, and what it refuses. public_abi_test.py INCLUDE_FOLDER"""
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
import public_abi

INCLUDE = sys.argv.pop()


class ALaterVersion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.released = public_abi.abi_of(INCLUDE)

    def broken_by(self, header, old, new):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(INCLUDE, folder, dirs_exist_ok=True)
            path = Path(folder, "froth", header)
            text = path.read_text()
            self.assertEqual(text.count(old), 1, old)
            path.write_text(text.replace(old, new))
            return sorted(public_abi.find_broken(self.released, public_abi.abi_of(folder)))

    def test_may_append_fields_to_a_struct_with_its_size(self):
        self.assertEqual(self.broken_by("froth.h", "} FrothViewInfo;", "uint64_t later; } FrothViewInfo;"), [])

    def test_may_add_functions_and_enumerators(self):
        self.assertEqual(self.broken_by("froth.h", "FROTH_API FrothResult frothUpdate", "FROTH_API void frothLater(void);\nFROTH_API FrothResult frothUpdate"), [])
        self.assertEqual(self.broken_by("froth_context.h", "  FROTH_RESULT_MAX", "  FROTH_ERROR_LATER = -100, FROTH_RESULT_MAX"), [])

    def test_may_not_insert_fields(self):
        self.assertEqual(self.broken_by("froth.h", "typedef struct FrothViewInfo {\n  uint32_t structSize;", "typedef struct FrothViewInfo {\n  uint32_t structSize; uint64_t later;"), ["struct FrothViewInfo"])

    def test_may_not_append_fields_to_a_struct_without_size(self):
        broken = self.broken_by("froth_camera.h", "} FrothImage;", "uint64_t later; } FrothImage;")
        self.assertIn("struct FrothImage", broken)
        self.assertIn("struct FrothRenderInfo", broken)

    def test_may_not_put_fields_into_padding(self):
        released = ["struct FrothPadded: size 24, align 8", "  0: uint32_t structSize", "  8: uint64_t serial", "  16: uint32_t bits"]
        for name, is_broken in (("later", True), ("padding", False)):
            today = ["struct FrothPadded: size 32, align 8", *released[1:], f"  20: uint32_t {name}", "  24: uint64_t last"]
            self.assertEqual(bool(public_abi.find_broken(released, today)), is_broken)

    def test_may_not_change_or_drop_what_there_is(self):
        self.assertEqual(self.broken_by("froth.h", "uint64_t uploadBytesQueued;", "double uploadBytesQueued;"), ["struct FrothFrameStatus"])
        self.assertEqual(self.broken_by("froth_context.h", "FROTH_ERROR_STATE = -9", "FROTH_ERROR_STATE = -10"), ["enum FrothResult: FROTH_ERROR_STATE = -9"])
        self.assertEqual(self.broken_by("froth.h", "frothDropFrame(FrothContext* context, uint64_t serial)", "frothDropFrame(FrothContext* context, uint32_t serial)"),
                         ["function FrothResult frothDropFrame(FrothContext *, uint64_t)"])


unittest.main(verbosity=2)
