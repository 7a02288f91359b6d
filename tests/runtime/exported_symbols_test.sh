#!/bin/sh
# The shared runtime exports exactly the functions of its headers, and links no more than it may.
#   exported_symbols_test.sh libfroth_runtime.so folder-of-headers own|program: whose operator new it uses
set -eu
library=$1
headers=$2
heap=$3

declared=$(cat "$headers"/*.h | grep -A1 '^FROTH_API' | grep -o 'froth[A-Z][A-Za-z]*(' | tr -d '(' | LC_ALL=C sort -u)
exported=$(nm -D --defined-only "$library" | awk '{print $3}' | LC_ALL=C sort -u)
if [ "$declared" != "$exported" ]; then
  echo "declared in $headers:" $declared
  echo "exported by $library:" $exported
  exit 1
fi

# No Vulkan loader, CGAL, GLFW, CUDA or image library; no C++ library beside the one within, but in sanitizer builds.
allowed='libzstd|libm|libgcc_s|libc|ld-linux[-a-z0-9_]*'
[ "$heap" = own ] || allowed="$allowed|libstdc\+\+|libasan|libubsan"
needed=$(readelf -d "$library" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')
foreign=$(echo "$needed" | grep -Ev "^($allowed)\.so" || true)
if [ -n "$foreign" ]; then
  echo "$library links" $foreign
  exit 1
fi
