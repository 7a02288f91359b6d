# Writes OUTPUT, the source of base/version.h: "0.1.0 (19a2b5e)" of a repository, "0.1.0" of an archive. Leaves the file alone where it
# says so already, so that nothing is built again. Called with -D VERSION, SOURCE_DIR, OUTPUT.
execute_process(COMMAND git -C ${SOURCE_DIR} describe --always --dirty --exclude * OUTPUT_VARIABLE commit
  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(commit)
  string(APPEND VERSION " (${commit})")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#include \"base/version.h\"\n\nconst char* const froth::kVersion = \"${VERSION}\";\n")
