/// \file  What the model found, as lines and as JSON.
#pragma once

#include "tools/warp_src/path_model.h"
#include "tools/warp_src/ray_model.h"

#include <string>

namespace plumb::warps {

class Report {
  public:
    /// Prints a line and keeps the numbers.
    void add(const std::string& mesh, const RayCell& cell);
    void add(const std::string& scene, const PathCell& cell);

    [[nodiscard]] std::string json() const;

  private:
    std::vector<std::string> rays_, paths_; ///< JSON objects
};

} // namespace plumb::warps
