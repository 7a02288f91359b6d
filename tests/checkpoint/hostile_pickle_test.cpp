// Pickles that are broken or want something. None may run anything, crash, hang, or take much memory.
#include "tests/checkpoint/import_checks.h"

namespace froth {
namespace {

std::string repeat(const std::string& text, size_t count) {
  std::string repeated;
  for (size_t i = 0; i < count; ++i) {
    repeated += text;
  }
  return repeated;
}

Result<Foam> importPickle(const std::string& pickle) {
  CheckpointSpec checkpoint = sampleCheckpoint();
  checkpoint.pickle = pickle;
  return importSpec(checkpoint);
}

TEST(HostilePickle, MayNotCallTheSystem) {
  const std::string call = pickleTuple({pickleText("touch owned")});
  expectRefusal(importPickle(pickleProgram(pickleCall(pickleGlobal("posix", "system"), call))),
                "data.pkl: byte 2: the pickle wants to call 'system' of module 'posix'");
  expectRefusal(importPickle("\x80\x04\x8c\x02os\x8c\x06system\x93" + call + "R."), "'system' of module 'os'");
  for (const char* name : {"eval", "exec", "__import__", "getattr"}) {
    expectRefusal(importPickle(pickleProgram(pickleGlobal("builtins", name))), name);
  }
}

TEST(HostilePickle, MayNotCallEvenWhatTorchOffersBeyondTensors) {
  for (const auto& [module, name] : {std::pair{"torch.storage", "_load_from_bytes"},
                                     {"torch._utils", "_rebuild_tensor"},
                                     {"torch._utils", "_rebuild_parameter"},
                                     {"torch", "ComplexFloatStorage"},
                                     {"torch", "load"},
                                     {"numpy.core.multiarray", "_reconstruct"}}) {
    expectRefusal(importPickle(pickleProgram(pickleGlobal(module, name))), name);
  }
}

TEST(HostilePickle, MayNotShowControlCharactersInTheMessage) {
  const Result<Foam> foam = importPickle(pickleProgram(pickleGlobal("\x1b[2J", std::string(10'000, 'x'))));
  expectRefusal(foam, "'?[2J'");
  EXPECT_LT(foam.error().message.size(), 500u);
}

TEST(HostilePickle, IsRefusedByTheNameOfAnOpcodeThatADictOfTensorsNeverNeeds) {
  for (const auto& [opcode, name] : {std::pair{"b", "BUILD"},
                                     {"i", "INST"},
                                     {"o", "OBJ"},
                                     {"\x81", "NEWOBJ"},
                                     {"\x82", "EXT1"},
                                     {"P", "PERSID"},
                                     {"\xff", "no pickle protocol"}}) {
    expectRefusal(importPickle(pickleProgram(std::string("}") + opcode)), name);
  }
}

TEST(HostilePickle, IsRefusedWhenItIsNoPickleOfProtocolTwoToFive) {
  for (const char* pickle : {"", "}.", "\x80\x01}.", "\x80\x06}.", "}\x80\x02."}) {
    expectRefusal(importPickle(pickle), "protocol");
  }
}

TEST(HostilePickle, IsRefusedWhereItBreaksOff) {
  const std::string whole = zipEntries(sampleCheckpoint(1, 1, 1))[0].bytes;
  for (size_t length = 0; length < whole.size(); ++length) {
    ASSERT_FALSE(importPickle(whole.substr(0, length))) << length;
  }
}

TEST(HostilePickle, IsRefusedWhenItMisusesItsStack) {
  for (const char* opcodes : {"R",
                              "t",
                              "u",
                              "s",
                              "a",
                              "e",
                              "q\1",
                              "h\1",
                              "Q",
                              "\x87",
                              "\x93",
                              "(R",
                              "((t",
                              "N(R",
                              "}Ns",
                              "}(Nu",
                              ")(Nu",
                              ")Na",
                              "])R",
                              "cpickle",
                              "\x8d\xff\xff\xff\xff\xff\xff\xff\xff",
                              "X\xff\xff\xff\xff",
                              "\x8a\xff",
                              "K",
                              "ctorch\nFloatStorage\n)R",
                              "ccollections\nOrderedDict\n]R",
                              "ctorch._utils\n_rebuild_tensor_v2\n)R",
                              ")Q",
                              "(NNNNNtQ"}) {
    expectRefusal(importPickle(pickleProgram(opcodes)), "data.pkl");
  }
}

TEST(HostilePickle, IsRefusedWhenItsResultIsNoDictOfTheTensors) {
  expectRefusal(importPickle(pickleProgram("]")), "no dict");
  expectRefusal(importPickle(pickleProgram("")), "no dict");
  expectRefusal(importPickle(pickleProgram("}")), "lacks the tensors 'points', 'density', 'radii'");
  CheckpointSpec checkpoint = sampleCheckpoint();
  std::erase_if(checkpoint.tensors, [](const auto& entry) { return entry.first == "texel_height"; });
  expectRefusal(importSpec(checkpoint), "lacks the tensors 'texel_height'");
  expectRefusal(importPickle(pickleProgram(pickleDict({{"points", pickleText("none")}}))), "'points'");
}

// Each of these would ruin an interpreter that recurses into its values or copies them.
TEST(HostilePickle, MayNestAndShareItsValuesWithoutHarm) {
  expectRefusal(importPickle(pickleProgram(join(")", repeat("\x85", 200'000)))), "no dict");  // ((((...
  expectRefusal(importPickle(pickleProgram(join("]", repeat("q\1h\1a", 40'000)))),
                "no dict");  // a list in itself
  expectRefusal(importPickle(pickleProgram(join("}q\1", repeat("h\1h\1s", 40'000)))),
                "lacks");  // a dict in itself
  expectRefusal(importPickle(pickleProgram(join(")", repeat("q\1h\1\x86", 50'000)))),
                "no dict");  // a tree of 2^50000 leaves
  expectRefusal(importPickle(pickleProgram(repeat("(", 200'000))), "no dict");
}

TEST(HostilePickle, MayNotBeLargerThanAnyDictOfTensors) {
  expectRefusal(importPickle(pickleProgram(repeat("N", 300'000))), "300003 bytes");
}

TEST(HostilePickle, MayNotHoldIntegersBeyondSixtyFourBits) {
  expectRefusal(importPickle(pickleProgram("\x8a\x09" + std::string(9, '\1'))), "an integer of 9 bytes");
}

}  // namespace
}  // namespace froth
