# Writes the files of FOLDER as C++ strings to OUT.  cmake -DFOLDER=… -DOUT=… -P embed.cmake
file(GLOB files RELATIVE ${FOLDER} ${FOLDER}/*)
set(lines "")
foreach(file ${files})
  file(READ ${FOLDER}/${file} text)
  string(APPEND lines "    {\"${file}\", R\"erp_text(${text})erp_text\"},\n")
endforeach()
file(WRITE ${OUT} "#include \"launch/erp/new/new_controller.hpp\"

namespace launch {

static constexpr Template templates[] = {
${lines}};

std::span<const Template> controller_templates() { return templates; }

}  // namespace launch
")
