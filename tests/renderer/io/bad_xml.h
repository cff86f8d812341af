/// \file  Scene files that must be refused, and the start of the message each must get.
#pragma once

#include "tests/renderer/io/load_scene_files.h"

namespace plumb::test {

struct BadCase {
    std::string content;
    std::string_view message; ///< how the message must begin, after the file's name
};

class BadXml : public SceneFiles {
  protected:
    void expect_refused(const std::vector<BadCase>& cases) const {
        for (const BadCase& bad : cases) {
            const std::string expected = "scene.xml:" + std::string(bad.message);
            const std::string got = error(bad.content);
            EXPECT_EQ(got.substr(0, expected.size()), expected)
                << "in full: " << got << "\nfor: " << bad.content.substr(0, 300);
            EXPECT_EQ(got.find('\n'), std::string::npos) << got;
        }
    }
    /// Each case stands in a scene, from line 2 on.
    void expect_refused_in_scene(std::vector<BadCase> cases) const {
        for (BadCase& bad : cases)
            bad.content = in_scene(bad.content);
        expect_refused(cases);
    }
};

} // namespace plumb::test
