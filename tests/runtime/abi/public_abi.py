#!/usr/bin/python3
"""The binary interface of the public headers as text: functions, structs with offsets, enumerators, numbers.

public_abi.py INCLUDE_FOLDER                 prints it
public_abi.py INCLUDE_FOLDER RELEASED_FILE   checks that programs built with a released version run with today's library

What a release said must still hold. A later version may add functions, enumerators, numbers, structs, and fields at the
end of a struct that begins with structSize. Such fields lie beyond what sizeof was: older callers leave bytes that pad a
struct undefined. A field that fills them is called padding, and nobody reads it."""
import os
import re
import sys
from pathlib import Path

try:
    from clang.cindex import Config, CursorKind, Index
except ImportError:
    print("python3-clang-14 is missing", file=sys.stderr)
    sys.exit(1 if os.environ.get("FROTH_REQUIRE_ALL") else 77)  # 77: skipped

Config.set_library_file("libclang-14.so.1")


def parse(folder):
    headers = sorted(path.name for path in Path(folder, "froth").glob("*.h"))
    text = "".join(f'#include "froth/{name}"\n' for name in headers)
    options = 1  # CXTranslationUnit_DetailedPreprocessingRecord: macros
    unit = Index.create().parse("all.c", ["-std=c11", f"-I{folder}"], [("all.c", text)], options)
    errors = [str(d) for d in unit.diagnostics if d.severity >= 3]
    if errors:
        sys.exit("\n".join(errors))
    return [c for c in unit.cursor.get_children() if c.location.file and "/froth/" in c.location.file.name]


def struct_lines(cursor):
    kind = cursor.type
    yield f"struct {cursor.spelling}: size {kind.get_size()}, align {kind.get_align()}"
    for field in kind.get_fields():
        yield f"  {field.get_field_offsetof() // 8}: {field.type.spelling} {field.spelling}"


def number_lines(cursor):
    tokens = [t.spelling for t in cursor.get_tokens()][1:]
    if tokens and re.search(r"\d", "".join(tokens)) and "__" not in "".join(tokens):
        yield f"define {cursor.spelling} {''.join(tokens)}"


def lines_of(cursor):
    if cursor.kind == CursorKind.FUNCTION_DECL:
        arguments = ", ".join(a.type.spelling for a in cursor.get_arguments())
        yield f"function {cursor.result_type.spelling} {cursor.spelling}({arguments})"
    elif cursor.kind == CursorKind.STRUCT_DECL and cursor.is_definition():
        yield from struct_lines(cursor)
    elif cursor.kind == CursorKind.ENUM_DECL:
        yield from (f"enum {cursor.spelling}: {c.spelling} = {c.enum_value}" for c in cursor.get_children())
    elif cursor.kind == CursorKind.TYPEDEF_DECL and not cursor.underlying_typedef_type.spelling.startswith(("struct ", "enum ")):
        yield f"typedef {cursor.spelling} = {cursor.underlying_typedef_type.spelling}"
    elif cursor.kind == CursorKind.MACRO_DEFINITION and cursor.spelling.startswith("FROTH_") and cursor.spelling != "FROTH_ABI_VERSION":
        yield from number_lines(cursor)


def blocks_of(lines):
    """Each line, or each struct with its fields, by its name."""
    blocks = {}
    for line in lines:
        if line.startswith("  "):
            blocks[name].append(line)
        else:
            name = line.split(":")[0] if line.startswith("struct ") else line
            blocks[name] = [line]
    return blocks


def size_of(block):
    return int(re.search(r"size (\d+)", block[0]).group(1))


def holds(released, today):
    if today is None:
        return False
    if len(released) == 1 or released[1] != "  0: uint32_t structSize":
        return today == released
    added = today[len(released):]
    in_padding = [f for f in added if int(f.split(":")[0]) < size_of(released) and not f.endswith(" padding")]
    return today[1:len(released)] == released[1:] and not in_padding


def abi_of(folder):
    return [line for cursor in parse(folder) for line in lines_of(cursor)]


def find_broken(released, today):
    """What no longer holds: the blocks of both, by name."""
    released, today = blocks_of(released), blocks_of(today)
    return {name: (block, today.get(name)) for name, block in released.items() if not holds(block, today.get(name))}


def main():
    today = abi_of(sys.argv[1])
    if len(sys.argv) == 2:
        print("\n".join(today))
        return
    broken = find_broken(Path(sys.argv[2]).read_text().splitlines(), today)
    for old, new in broken.values():
        print("released:", *old, "today:", *(new or ["nothing"]), sep="\n")
    if broken:
        sys.exit(f"{len(broken)} declarations are no longer what {sys.argv[2]} says: raise the major of FROTH_ABI_VERSION, or undo it")
    print(f"All declarations of {sys.argv[2]} hold")


if __name__ == "__main__":
    main()
