# Embeds text files as C++: embed_text(OUTPUT file.cpp FUNCTION name FILES a.glsl b.glsl ...) generates the function
# `std::span<const EmbeddedText> name()` of rayengine, declared in gpu/device/shaders.h. A text is named by its path from the root.
# Run as a script, it writes that file. C++ string literals have a limit of length, so texts are arrays of characters.
if(CMAKE_SCRIPT_MODE_FILE)
  set(arrays "")
  set(table "")
  set(index 0)
  foreach(name IN LISTS FILES)
    file(READ ${ROOT}/${name} hex HEX)
    string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
    string(APPEND arrays "constexpr char text${index}[] = {${bytes}0};\n")
    string(APPEND table "    {\"${name}\", {text${index}, sizeof(text${index}) - 1}},\n")
    math(EXPR index "${index} + 1")
  endforeach()
  file(WRITE ${OUTPUT} "#include \"gpu/device/shaders.h\"\n\nnamespace rayengine {\nnamespace {\n\n${arrays}\n"
    "constexpr EmbeddedText table[] = {\n${table}};\n\n}  // namespace\n\n"
    "std::span<const EmbeddedText> ${FUNCTION}() { return table; }\n\n}  // namespace rayengine\n")
  return()
endif()

function(embed_text)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "OUTPUT;FUNCTION" "FILES")
  add_custom_command(OUTPUT ${arg_OUTPUT}
    COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -DOUTPUT=${arg_OUTPUT} -DFUNCTION=${arg_FUNCTION} "-DFILES=${arg_FILES}"
      -P ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
    DEPENDS ${arg_FILES} ${PROJECT_SOURCE_DIR}/cmake/embed.cmake WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} VERBATIM)
endfunction()
