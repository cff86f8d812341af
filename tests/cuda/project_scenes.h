/// \file  The scenes of the project as parameters of tests.
#pragma once

#include "renderer/io/load_scene.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>
#include <unistd.h>
#include <vector>

namespace plumb::test {

inline std::vector<std::filesystem::path> project_scenes() {
    std::vector<std::filesystem::path> scenes;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(PLUMB_SOURCE_DIR) / "scenes"))
        if (entry.path().extension() == ".xml")
            scenes.push_back(entry.path());
    std::sort(scenes.begin(), scenes.end());
    return scenes;
}

/// Loads a scene of the project; terrain's mesh is made first where it is not there, as
/// tools/render does.
inline Scene
load_project_scene(const std::filesystem::path& file,
                   const std::vector<std::pair<std::string, std::string>>& parameters) {
    const std::filesystem::path folder = file.parent_path();
    const std::filesystem::path mesh = folder / "meshes" / "terrain.ply";
    if (file.stem() == "terrain" && !std::filesystem::exists(mesh)) {
        const std::filesystem::path made = mesh.string() + "." + std::to_string(::getpid());
        const std::string command = "python3 '" + (folder / "make_terrain.py").string() + "' '" +
                                    made.string() + "' >/dev/null";
        if (std::system(command.c_str()) == 0)
            std::filesystem::rename(made, mesh); // another test may have made it meanwhile
    }
    return load_scene({file, parameters, false});
}

inline std::string
project_scene_name(const ::testing::TestParamInfo<std::filesystem::path>& scene) {
    std::string name = scene.param.stem().string();
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

} // namespace plumb::test
