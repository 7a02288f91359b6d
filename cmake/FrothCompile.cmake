# Compile settings every target of Froth shares.

find_program(FROTH_CCACHE ccache)
if(FROTH_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_C_COMPILER_LAUNCHER ${FROTH_CCACHE})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${FROTH_CCACHE})
  set(CMAKE_CUDA_COMPILER_LAUNCHER ${FROTH_CCACHE})
endif()

if(FROTH_SANITIZE)
  add_compile_options(-fsanitize=${FROTH_SANITIZE} -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${FROTH_SANITIZE})
endif()

# Includes are written from the repository's root: #include "base/result.h".
function(froth_target_defaults target)
  target_include_directories(${target} PRIVATE ${CMAKE_SOURCE_DIR})
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wpedantic)
  if(FROTH_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()
