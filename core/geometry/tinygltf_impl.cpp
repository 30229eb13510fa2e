// The one place where tinygltf is compiled: from its header, since the library Debian ships decodes pictures and opens
// files on its own.
#include <fstream>

#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
