# cmake -DOUT=file.cpp "-DSCENES=a.json;b.json" -P embed_scenes.cmake: the scenes as one C++ source.
set(text "#include \"camera/simulation/built_in_scenes.hpp\"\n\nnamespace flogmap {\nnamespace {\n\nconstexpr BuiltInScene kScenes[] = {\n")
foreach(scene ${SCENES})
  get_filename_component(name ${scene} NAME_WE)
  file(READ ${scene} json)
  string(APPEND text "    {\"${name}\", R\"scene(${json})scene\"},\n")
endforeach()
string(APPEND text "};\n\n}  // namespace\n\nconst std::span<const BuiltInScene> kBuiltInScenes = kScenes;\n\n}  // namespace flogmap\n")
file(WRITE ${OUT} "${text}")
