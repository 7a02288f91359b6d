// Structs of the public headers that begin with structSize.
#pragma once

namespace froth {

template <class T>
T makeStruct() {
  T value{};
  value.structSize = sizeof(T);
  return value;
}

}  // namespace froth
