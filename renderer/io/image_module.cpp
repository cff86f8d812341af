#include "renderer/io/image_module.h"

#include <bit>
#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace plumb {
namespace {

constexpr const char* file_name = "libplumb_oiio.so";

std::vector<std::filesystem::path> candidates() {
    std::vector<std::filesystem::path> paths;
    if (const char* folder = std::getenv("PLUMB_MODULE_DIR"); folder && *folder)
        paths.push_back(std::filesystem::path(folder) / file_name);
    std::error_code ignored;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", ignored);
    if (!program.empty()) {
        paths.push_back(program.parent_path() / file_name);
        paths.push_back(program.parent_path().parent_path() / "lib" / "plumbline" / file_name);
    }
    return paths;
}

template <typename Function> Function* function(void* library, const char* name) {
    void* address = dlsym(library, name);
    if (!address)
        throw std::runtime_error(std::string(file_name) + " has no " + name);
    return std::bit_cast<Function*>(address);
}

ImageModule load() {
    std::string tried;
    for (const auto& path : candidates()) {
        void* library = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
        if (!library) {
            const char* reason = dlerror();
            tried += std::string(tried.empty() ? "" : "; ") + (reason ? reason : "unknown reason");
            continue;
        }
        if (function<OiioVersionFunction>(library, "plumb_oiio_version")() != oiio_module_version)
            throw std::runtime_error(path.string() + " belongs to another build");
        return {function<OiioEncodeFunction>(library, "plumb_oiio_encode"),
                function<OiioDecodeFunction>(library, "plumb_oiio_decode")};
    }
    throw std::runtime_error("the OpenImageIO module cannot be loaded: " + tried);
}

} // namespace

const ImageModule& image_module() {
    static const ImageModule module = load();
    return module;
}

} // namespace plumb
