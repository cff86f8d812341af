/// \file  The text of the one exception of loading and writing.

#include "renderer/scene/error.h"

#include <gtest/gtest.h>

namespace plumb::test {
namespace {

TEST(SceneError, SaysWhereWhatAndFromWhereItWasIncluded) {
    const SceneError error(ErrorKind::mesh, {"a.xml", 3, 7}, "no mesh", {{"b.xml", 1, 2}});
    EXPECT_STREQ(error.what(), "a.xml:3:7: error: no mesh\n  included from b.xml:1:2");
    EXPECT_EQ(error.exit_code(), 4);
}

TEST(SceneError, QuotesNoControlCharacters) {
    const SceneError error(ErrorKind::scene, {"a.xml"}, "file 'a\r\x1b[2J\x7f\xc3\xa9' not found");
    EXPECT_STREQ(error.what(), "a.xml: error: file 'a??[2J?\xc3\xa9' not found");
}

} // namespace
} // namespace plumb::test
