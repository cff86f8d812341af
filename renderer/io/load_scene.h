/// \file  A scene file to a Scene.
#pragma once

#include "renderer/scene/error.h"
#include "renderer/scene/scene.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace plumb {

struct LoadOptions {
    std::filesystem::path file;
    /// Values for `$name` in the file, before its <default>s.
    std::vector<std::pair<std::string, std::string>> parameters;
    /// What is known but not supported is replaced and listed in Scene::ignored, not refused.
    bool lenient = false;
};

/// Reads Mitsuba-style XML, dialects 0.4 to 3 (README.md of this folder lists what is read), with
/// the meshes that it names. Throws SceneError: kind scene for the XML, kind mesh for mesh files.
[[nodiscard]] Scene load_scene(const LoadOptions& options);

} // namespace plumb
