#include "tests/commands/shader_accesses.h"

#include <map>
#include <stdexcept>

#include "tests/commands/spirv.h"

namespace froth::test {
namespace {

using namespace spirv;

struct Type {
  uint32_t op = 0;
  std::vector<uint32_t> members;  // of a struct; of others: the element
  uint32_t length = 0;            // of an array or vector
  uint32_t storage = 0;           // of a pointer
  uint32_t bytes = 0;             // of a number
};

using Locations = std::set<Location>;

// What is followed: addresses. `places` of an id that is a pointer to memory; `variables` of one to what only the
// thread sees; `addresses` of a value that is, or holds, addresses. Members of values and variables are not told apart.
class Tracer {
 public:
  explicit Tracer(std::span<const uint32_t> spirv) : instructions_(split(spirv)) {
    for (const Instruction& instruction : instructions_) declare(instruction);
    size_t known = 0;
    do {
      known = known_;
      for (const Instruction& instruction : instructions_) follow(instruction);
    } while (known_ != known);
  }
  std::set<ShaderAccess> accesses;

 private:
  void declare(const Instruction& instruction) {
    const auto& w = instruction.words;
    switch (instruction.op) {
      case kTypeInt:
      case kTypeFloat:
        types_[w[1]] = {instruction.op, {}, 0, 0, w[2] / 8};
        break;
      case kTypeVector:
        types_[w[1]] = {instruction.op, {w[2]}, w[3], 0, 0};
        break;
      case kTypeArray:
        types_[w[1]] = {instruction.op, {w[2]}, constants_[w[3]], 0, 0};
        break;
      case kTypeRuntimeArray:
        types_[w[1]] = {instruction.op, {w[2]}, 0, 0, 0};
        break;
      case kTypeStruct:
        types_[w[1]] = {instruction.op, {w.begin() + 2, w.end()}, 0, 0, 0};
        break;
      case kTypePointer:
        types_[w[1]] = {instruction.op, {w[3]}, 0, w[2], 0};
        break;
      case kConstant:
        typeOf_[w[2]] = w[1];
        constants_[w[2]] = w[3];
        break;
      case kDecorate:
        if (w[2] == kArrayStride) strides_[w[1]] = w[3];
        if (w[2] == kBinding) bindings_[w[1]] = w[3];
        break;
      case kMemberDecorate:
        if (w[3] == kOffset) offsets_[{w[1], w[2]}] = w[4];
        break;
      case kVariable:
        declareVariable(w[1], w[2], w[3]);
        break;
      case kFunction:
        function_ = w[2];
        break;
      case kFunctionParameter:
        typeOf_[w[2]] = w[1];
        parameters_[function_].push_back(w[2]);
        break;
      case kReturnValue:
        returned_[function_].push_back(w[1]);
        break;
      case kLoad:
      case kFunctionCall:
      case kAccessChain:
      case kInBoundsAccessChain:
      case kCompositeConstruct:
      case kCompositeExtract:
      case kCompositeInsert:
      case kCopyObject:
      case kCopyLogical:
      case kSelect:
      case kPhi:
        typeOf_[w[2]] = w[1];
        break;
      default:
        break;
    }
  }

  void declareVariable(uint32_t type, uint32_t id, uint32_t storage) {
    typeOf_[id] = type;
    if (storage == kPushConstant) {
      places_[id] = {Location{Root::kPushConstants, 0, {}}};
    } else if (storage == kUniformConstant || storage == kUniform || storage == kStorageBuffer) {
      places_[id] = {Location{Root::kDescriptor, bindings_[id], {}}};
    } else {
      variables_[id] = {id};
    }
  }

  template <class Set>
  void add(Set& to, const Set& from) {
    const size_t before = to.size();
    to.insert(from.begin(), from.end());
    known_ += to.size() - before;
  }

  void note(const Locations& locations, AccessMode mode) {
    for (const Location& location : locations) {
      if (location.root == Root::kPushConstants && location.addresses.empty()) continue;
      known_ += accesses.insert({location, mode}).second;
    }
  }

  void follow(const Instruction& instruction) {
    const auto& w = instruction.words;
    switch (instruction.op) {
      case kAccessChain:
      case kInBoundsAccessChain:
        add(variables_[w[2]], variables_[w[3]]);
        for (const Location& base : places_[w[3]]) chain(w, base, types_[typeOf_[w[3]]].members[0], 4);
        break;
      case kPtrAccessChain:
        throw std::runtime_error("OpPtrAccessChain is not known here");
      case kLoad:
        load(w[1], w[2], w[3]);
        break;
      case kStore:
        note(places_[w[1]], AccessMode::kWrite);
        for (const uint32_t variable : variables_[w[1]]) add(held_[variable], addressesIn(w[2]));
        break;
      case kCopyMemory:
        throw std::runtime_error("OpCopyMemory is not known here");
      case kFunctionCall:
        call(w);
        break;
      case kCompositeConstruct:
        for (const uint32_t part : w.subspan(3)) add(addressesIn(w[2]), addressesIn(part));
        break;
      case kCompositeInsert:
        add(addressesIn(w[2]), addressesIn(w[4]));
        [[fallthrough]];
      case kCompositeExtract:
      case kCopyObject:
      case kCopyLogical:
        add(addressesIn(w[2]), addressesIn(w[3]));
        break;
      case kSelect:
        add(addressesIn(w[2]), addressesIn(w[4]));
        add(addressesIn(w[2]), addressesIn(w[5]));
        break;
      case kPhi:
        for (size_t i = 3; i < w.size(); i += 2) add(addressesIn(w[2]), addressesIn(w[i]));
        break;
      case kImageWrite:
        note(images_[w[1]], AccessMode::kWrite);
        break;
      case kImageFetch:
      case kImageRead:
        note(images_[w[3]], AccessMode::kRead);
        break;
      default:
        if (isAtomic(instruction.op)) note(places_[w[instruction.op == kAtomicStore ? 1 : 3]], AccessMode::kAtomic);
    }
  }

  // A pointer that was loaded, or computed, is an address: what it points to has places of its own.
  Locations& addressesIn(uint32_t id) { return isAddress(id) ? places_[id] : values_[id]; }
  bool isAddress(uint32_t id) { return types_[typeOf_[id]].storage == kPhysicalStorageBuffer; }

  void load(uint32_t type, uint32_t id, uint32_t pointer) {
    if (!types_.contains(type)) {  // an image
      add(images_[id], places_[pointer]);
      return;
    }
    note(places_[pointer], AccessMode::kRead);
    for (const Location& place : places_[pointer]) collectAddresses(type, place, addressesIn(id));
    for (const uint32_t variable : variables_[pointer]) add(addressesIn(id), held_[variable]);
  }

  // Addresses in a value of `type` that lies at `place`.
  void collectAddresses(uint32_t type, const Location& place, Locations& found) {
    if (types_[type].op == kTypePointer) {
      Location target{place.root, place.binding, place.addresses};
      target.addresses.push_back(place.place + place.element);
      add(found, Locations{target});
    } else if (types_[type].op == kTypeStruct) {
      for (uint32_t i = 0; i < types_[type].members.size(); ++i) {
        Location member = place;
        (member.isInArray ? member.element : member.place) += offsets_[{type, i}];
        collectAddresses(types_[type].members[i], member, found);
      }
    }
  }

  // words[index] goes into a value of `type` at `place`.
  void chain(std::span<const uint32_t> words, Location place, uint32_t type, size_t index) {
    if (index == words.size()) {
      add(places_[words[2]], Locations{place});
      return;
    }
    const Type& outer = types_[type];
    const auto constant = constants_.find(words[index]);
    uint32_t& offset = place.isInArray ? place.element : place.place;
    if (outer.op == kTypeStruct) {
      offset += offsets_[{type, constant->second}];
      chain(words, place, outer.members[constant->second], index + 1);
    } else if (outer.op == kTypeRuntimeArray) {
      place.isInArray = true;
      chain(words, place, outer.members[0], index + 1);
    } else {
      if (outer.op != kTypeVector && outer.op != kTypeArray) throw std::runtime_error("a type that is not known here");
      const uint32_t stride = outer.op == kTypeVector ? types_[outer.members[0]].bytes : strides_[type];
      const uint32_t first = constant == constants_.end() ? 0 : constant->second;
      const uint32_t last = constant == constants_.end() ? outer.length - 1 : first;
      const uint32_t begin = offset;
      for (uint32_t i = first; i <= last; ++i) {
        offset = begin + i * stride;
        chain(words, place, outer.members[0], index + 1);
      }
    }
  }

  void call(std::span<const uint32_t> words) {
    const auto& parameters = parameters_[words[3]];
    for (size_t i = 0; i < parameters.size(); ++i) {
      add(addressesIn(parameters[i]), addressesIn(words[4 + i]));
      add(variables_[parameters[i]], variables_[words[4 + i]]);
    }
    for (const uint32_t value : returned_[words[3]]) add(addressesIn(words[2]), addressesIn(value));
  }

  std::vector<Instruction> instructions_;
  std::map<uint32_t, Type> types_;
  std::map<uint32_t, uint32_t> typeOf_, constants_, strides_, bindings_;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> offsets_;
  std::map<uint32_t, std::vector<uint32_t>> parameters_, returned_;  // of functions
  uint32_t function_ = 0;
  std::map<uint32_t, Locations> places_, values_, images_;
  std::map<uint32_t, Locations> held_;                // by variables
  std::map<uint32_t, std::set<uint32_t>> variables_;  // that a pointer may point to
  size_t known_ = 0;
};

}  // namespace

std::set<ShaderAccess> findAccesses(std::span<const uint32_t> spirv) { return Tracer(spirv).accesses; }

}  // namespace froth::test
