/// \file  The one place that knows every kind of Intersector.
#include "accel/embree/embree_intersector.h"
#include "accel/intersector.h"
#include "accel/naive/naive_intersector.h"
#include "accel/sah/sah_intersector.h"

#include <stdexcept>

namespace plumb {

std::unique_ptr<Intersector> make_intersector(AccelKind kind, GeometryView geometry,
                                              const BuildOptions& options) {
    switch (kind) {
    case AccelKind::naive:
        return std::make_unique<NaiveIntersector>(geometry, options.triangle_test);
    case AccelKind::sah: return std::make_unique<SahIntersector>(geometry, options);
    case AccelKind::embree: return make_embree_intersector(geometry, options);
    }
    throw std::runtime_error("unknown acceleration structure");
}

} // namespace plumb
