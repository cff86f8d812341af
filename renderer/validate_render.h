/// \file  --validate: the render's own rays through a second intersector, and what came of it.
#pragma once

#include "accel/validate/replay.h"
#include "renderer/options.h"
#include "renderer/scene/scene_view.h"

namespace plumb {

struct ValidationResult {
    AccelKind first = AccelKind::sah, second = AccelKind::embree;
    ValidationReport report;
    Replay replay; ///< without rays where there is nothing to write
    std::filesystem::path replay_file;
    Camera camera; ///< to name the place of camera rays on the film
    int width = 0, height = 0;
};

/// The second intersector and the one that compares.
class RenderValidation {
  public:
    /// `options.validate` is set. `scene`, what `view` of it shows and `first` must outlive it.
    /// Throws what make_intersector throws.
    RenderValidation(const Options& options, const Scene& scene, const SceneView& view,
                     const Intersector& first);

    /// Answers as `first` does.
    [[nodiscard]] const Intersector& intersector() const { return both_; }
    /// After the render.
    [[nodiscard]] ValidationResult result() const;

  private:
    const Options& options_;
    const Scene& scene_;
    SceneView view_;
    std::unique_ptr<Intersector> second_;
    ValidatingIntersector both_;
};

[[nodiscard]] std::string table_of(const ValidationResult& result);
/// An object for --stats.
[[nodiscard]] std::string to_json(const ValidationResult& result);

} // namespace plumb
