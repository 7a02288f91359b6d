# Installs the programs together with the shared libraries they need, except the C and C++ runtime, so that the folder runs
# on another machine: cmake --preset portable && cmake --build --preset portable && cmake --install build/portable --prefix DIR
install(TARGETS froth_tool RUNTIME_DEPENDENCY_SET froth_portable RUNTIME DESTINATION . COMPONENT portable)
install(RUNTIME_DEPENDENCY_SET froth_portable
  PRE_EXCLUDE_REGEXES "^ld-linux" "^lib(c|m|dl|rt|pthread|stdc\\+\\+|gcc_s)\\.so"
  DESTINATION . COMPONENT portable)
