// What every C entry point does before and after its work: exceptions, null pointers, struct sizes.
#pragma once

#include <new>

#include "froth/froth_reader.h"
#include "runtime/api/struct_size.h"
#include "runtime/context/context.h"

namespace froth {

// Runs call(name); no exception crosses the C boundary.
template <class Call>
FrothResult guard(const Messages& messages, const char* name, Call call) {
  try {
    return call(name);
  } catch (const std::bad_alloc&) {
    return messages.fail(FROTH_ERROR_MEMORY, name, "host memory is exhausted");
  } catch (...) {
    return messages.fail(FROTH_ERROR_STATE, name, "an unexpected failure inside the library");
  }
}

template <class Call>
FrothResult guard(FrothContext* context, const char* name, Call call) {
  return context ? guard(context->messages, name, call) : FROTH_ERROR_ARGUMENT;
}

inline FrothResult failNull(const FrothContext& context, const char* call, const char* parameter) {
  return context.messages.fail(FROTH_ERROR_ARGUMENT, call, "%s: null", parameter);
}

// Reads a caller's struct, with a message where that fails. `within`: the field and the dot that lead to the struct.
template <class T>
FrothResult readInput(const Messages& messages, const char* call, const T* given, T& known, const char* within = "") {
  if (!given) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "info: null");
  }
  const FrothResult result = readStruct(*given, known);
  if (result == FROTH_ERROR_ARGUMENT) {
    return messages.fail(result, call, "%sstructSize: %u; set it to sizeof the struct", within, given->structSize);
  }
  if (result == FROTH_ERROR_VERSION) {
    return messages.fail(
        result, call, "%sstructSize: %u, this library knows %zu, and fields beyond are not zero; use a newer library",
        within, given->structSize, sizeof(T));
  }
  return result;
}

// The same for what tells of an asset; `reader` becomes what known.reader points to.
inline FrothResult readAssetInfo(const Messages& messages, const char* call, const FrothAssetInfo* given,
                                 FrothAssetInfo& known, FrothReader& reader) {
  FrothResult result = readInput(messages, call, given, known);
  if (result == FROTH_OK && known.reader) {
    result = readInput(messages, call, known.reader, reader, "reader.");
    known.reader = &reader;
  }
  return result;
}

template <class T>
FrothResult writeOutput(const Messages& messages, const char* call, const T& known, T* given) {
  if (!given) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "status: null");
  }
  if (!writeStruct(known, *given)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "structSize: %u; set it to sizeof the struct", given->structSize);
  }
  return FROTH_OK;
}

}  // namespace froth
