#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/core/temporary_folder.h"

namespace lumorph {

/// While it lives, resources are a copy in which one shader does not compile, in its third line.
class BrokenShader {
public:
    explicit BrokenShader(const std::string& name) {
        namespace fs = std::filesystem;
        const fs::path resources = folder_.path() / "resources";
        fs::copy(LUMORPH_SOURCE_DIR "/resources", resources, fs::copy_options::recursive);
        breakToo(name);
        ::setenv("LUMORPH_RESOURCES", resources.c_str(), 1);
    }
    void breakToo(const std::string& name) const {
        std::ofstream(folder_.path() / "resources/shaders" / name)
            << "out vec4 color;\nvoid main() {\n    color = nothing;\n}\n";
    }
    ~BrokenShader() { ::unsetenv("LUMORPH_RESOURCES"); }
    BrokenShader(const BrokenShader&) = delete;
    BrokenShader& operator=(const BrokenShader&) = delete;

private:
    TemporaryFolder folder_;
};

} // namespace lumorph
