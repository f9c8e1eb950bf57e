# Writes OUTPUT, a C++ file with the table kShaderFiles of render/shader_files.h, from the list FILES.
set(table "")
set(count 0)
foreach(file IN LISTS FILES)
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  string(APPEND table "    {\"${name}\", R\"shader(${text})shader\"},\n")
  math(EXPR count "${count} + 1")
endforeach()
file(WRITE ${OUTPUT} "// Generated from shaders/.
#include \"render/shader_files.h\"

namespace smokebox {
const ShaderFile kShaderFiles[] = {
${table}};
const int kShaderFileCount = ${count};
}  // namespace smokebox
")
