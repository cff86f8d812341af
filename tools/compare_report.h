/// \file  What plumb_compare prints and decides.
#pragma once

#include "renderer/io/compare_images.h"
#include "tools/compare_options.h"

#include <optional>
#include <string>
#include <vector>

namespace plumb {

struct CompareReport {
    ImageComparison measures;
    std::optional<ZTest> z; ///< empty where variance or sample counts are not known
};

/// One line for each threshold that is exceeded and each test that failed; empty: all is well.
[[nodiscard]] std::vector<std::string> complaints(const CompareReport& report,
                                                  const CompareOptions& options);

/// A table for people.
[[nodiscard]] std::string as_text(const CompareReport& report, const CompareOptions& options);

/// One JSON object in one line. Numbers that are not finite are null.
[[nodiscard]] std::string as_json(const CompareReport& report, const CompareOptions& options);

} // namespace plumb
