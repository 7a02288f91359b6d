# What scripts/demo, scripts/test and scripts/test-gpu share: packages and builds. Sourced, not run.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"

# Debian 12 packages that every build needs.
build_packages=(
  build-essential cmake ninja-build pkg-config
  libcgal-dev libtbb-dev libfmt-dev libglm-dev libzstd-dev libdraco-dev libbenchmark-dev libflatbuffers-dev flatbuffers-compiler libxxhash-dev
  libcli11-dev nlohmann-json3-dev libpng-dev libjpeg-dev zlib1g-dev libtinygltf-dev libkainjow-mustache-dev
  glslang-tools libvulkan-dev libglfw3-dev libimgui-dev libcurl4-openssl-dev mesa-vulkan-drivers
)

# Installs what is missing; silent and without network where nothing is.
install_packages() {
  local missing=() package
  for package in "$@"; do
    dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  local as_root=()
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  echo "Installing: ${missing[*]}"
  "${as_root[@]}" apt-get update -qq
  DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# Slang's compiler, from a Python package that holds it (15 MB): build/slang/slangtorch/bin/slangc, where CMake looks. Needs python3-pip
# and unzip.
fetch_slang() {
  local folder=build/slang package=slangtorch==1.3.22
  [ "$(cat "$folder/package" 2>/dev/null)" = "$package" ] && return
  rm -rf "$folder"
  mkdir -p "$folder"
  # A network without PyPI is no fault of the sources.
  python3 -m pip download --quiet --no-deps --only-binary :all: --dest "$folder" "$package" &&
    unzip -q "$folder/slangtorch-*.whl" 'slangtorch/bin/*' -d "$folder" &&
    chmod +x "$folder/slangtorch/bin/slangc" &&
    echo "$package" >"$folder/package" ||
    echo "$package cannot be had: the tests of froth_walk.slang are left out"
}

# Where ccache compiles: headers compiled once for several files would keep it from remembering those files.
export CCACHE_SLOPPINESS=pch_defines,time_macros

# build PRESET [-DNAME=VALUE ...] [TARGET ...]
build() {
  local preset=$1 settings=()
  shift
  while [[ ${1:-} == -D* ]]; do
    settings+=("$1")
    shift
  done
  local log=build/configure-$preset.log
  mkdir -p build
  cmake --preset "$preset" "${settings[@]}" >"$log" 2>&1 || { cat "$log"; return 1; }
  cmake --build --preset "$preset" ${1:+--target "$@"}
}
