#!/bin/sh
# The shared runtime exports exactly the functions of its headers, and links no more than it may.
#   exported_symbols_test.sh libfroth_runtime.so folder-of-headers
set -eu
library=$1
headers=$2

declared=$(cat "$headers"/*.h | grep -A1 '^FROTH_API' | grep -o 'froth[A-Z][A-Za-z]*(' | tr -d '(' | LC_ALL=C sort -u)
exported=$(nm -D --defined-only "$library" | awk '{print $3}' | LC_ALL=C sort -u)
if [ "$declared" != "$exported" ]; then
  echo "declared in $headers:" $declared
  echo "exported by $library:" $exported
  exit 1
fi

# No Vulkan loader, CGAL, GLFW, CUDA or image library; the last two are of sanitizer builds.
allowed='libzstd|libstdc\+\+|libm|libgcc_s|libc|ld-linux[-a-z0-9_]*|libasan|libubsan'
needed=$(readelf -d "$library" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')
foreign=$(echo "$needed" | grep -Ev "^($allowed)\.so" || true)
if [ -n "$foreign" ]; then
  echo "$library links" $foreign
  exit 1
fi
