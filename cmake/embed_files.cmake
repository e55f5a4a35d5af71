# Writes a C++ source in which each file is a text of the library.
#   cmake -DOUT=<source> -DHEADER=<include> -DSPACE=<namespace> -DNAMES=<name>,... -DFILES=<path>,...
#         -P embed_files.cmake
# The files are UTF-8 without the sequence `)embedded"`. A name without a file is an empty text.
set(text "// Written by the build from the files of the repository and of its packages.\n")
string(APPEND text "#include \"${HEADER}\"\n\nnamespace ${SPACE} {\n")
string(REPLACE "," ";" names "${NAMES}")
string(REPLACE "," ";" files "${FILES}")
foreach(name IN LISTS names)
  if(files STREQUAL "")
    string(APPEND text "\nconst std::string_view ${name};\n")
    continue()
  endif()
  list(POP_FRONT files path)
  file(READ "${path}" content)
  string(FIND "${content}" ")embedded\"" end)
  if(NOT end EQUAL -1)
    message(FATAL_ERROR "${path}: holds the mark that ends an embedded text")
  endif()
  string(APPEND text "\nconst std::string_view ${name} = R\"embedded(${content})embedded\";\n")
endforeach()
file(WRITE "${OUT}" "${text}\n}  // namespace ${SPACE}\n")
