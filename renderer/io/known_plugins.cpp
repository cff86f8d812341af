/// \file  Plugin names, from the documentation of Mitsuba 0.6 and Mitsuba 3.
#include "renderer/io/known_plugins.h"

#include <array>

namespace plumb {
namespace {

using Name = std::string_view;

constexpr std::array bsdfs{Name("diffuse"),
                           Name("roughdiffuse"),
                           Name("dielectric"),
                           Name("thindielectric"),
                           Name("roughdielectric"),
                           Name("conductor"),
                           Name("roughconductor"),
                           Name("plastic"),
                           Name("roughplastic"),
                           Name("coating"),
                           Name("roughcoating"),
                           Name("bumpmap"),
                           Name("normalmap"),
                           Name("phong"),
                           Name("ward"),
                           Name("mixturebsdf"),
                           Name("blendbsdf"),
                           Name("mask"),
                           Name("twosided"),
                           Name("difftrans"),
                           Name("hk"),
                           Name("irawan"),
                           Name("null"),
                           Name("principled"),
                           Name("principledthin"),
                           Name("measured"),
                           Name("measured_polarized"),
                           Name("circular"),
                           Name("polarizer"),
                           Name("retarder"),
                           Name("pplastic"),
                           Name("hair"),
                           Name("rtrans")};
constexpr std::array shapes{
    Name("obj"),        Name("ply"),        Name("serialized"),    Name("sphere"),
    Name("cylinder"),   Name("rectangle"),  Name("disk"),          Name("cube"),
    Name("hair"),       Name("shapegroup"), Name("instance"),      Name("heightfield"),
    Name("deformable"), Name("merge"),      Name("bsplinecurve"),  Name("linearcurve"),
    Name("sdfgrid"),    Name("ellipsoids"), Name("ellipsoidsmesh")};
constexpr std::array emitters{Name("area"),         Name("point"),      Name("spot"),
                              Name("directional"),  Name("collimated"), Name("directionalarea"),
                              Name("constant"),     Name("envmap"),     Name("sky"),
                              Name("sun"),          Name("sunsky"),     Name("projector"),
                              Name("timed_sunsky"), Name("volumelight")};
constexpr std::array sensors{Name("perspective"),   Name("thinlens"),     Name("orthographic"),
                             Name("telecentric"),   Name("spherical"),    Name("irradiancemeter"),
                             Name("radiancemeter"), Name("fluencemeter"), Name("perspective_rdist"),
                             Name("distant"),       Name("batch")};
constexpr std::array films{Name("hdrfilm"), Name("ldrfilm"), Name("tiledhdrfilm"), Name("mfilm"),
                           Name("specfilm")};
constexpr std::array filters{Name("box"),      Name("tent"),       Name("gaussian"),
                             Name("mitchell"), Name("catmullrom"), Name("lanczos")};
constexpr std::array samplers{Name("independent"), Name("sobol"),      Name("ldsampler"),
                              Name("halton"),      Name("hammersley"), Name("stratified"),
                              Name("multijitter"), Name("orthogonal")};
constexpr std::array integrators{Name("path"),
                                 Name("direct"),
                                 Name("volpath"),
                                 Name("volpath_simple"),
                                 Name("volpathmis"),
                                 Name("bdpt"),
                                 Name("photonmapper"),
                                 Name("ppm"),
                                 Name("sppm"),
                                 Name("pssmlt"),
                                 Name("mlt"),
                                 Name("erpt"),
                                 Name("ptracer"),
                                 Name("adaptive"),
                                 Name("vpl"),
                                 Name("irrcache"),
                                 Name("ao"),
                                 Name("field"),
                                 Name("multichannel"),
                                 Name("motion"),
                                 Name("moment"),
                                 Name("aov"),
                                 Name("depth"),
                                 Name("stokes"),
                                 Name("prb"),
                                 Name("prb_basic"),
                                 Name("prbvolpath"),
                                 Name("direct_projective"),
                                 Name("prb_projective")};
constexpr std::array textures{
    Name("bitmap"),       Name("checkerboard"), Name("gridtexture"), Name("scale"),
    Name("vertexcolors"), Name("wireframe"),    Name("curvature"),   Name("mesh_attribute"),
    Name("volume"),       Name("uniform"),      Name("rawconstant"), Name("srgb"),
    Name("d65"),          Name("blackbody"),    Name("regular"),     Name("irregular")};
constexpr std::array media{Name("homogeneous"), Name("heterogeneous")};

constexpr std::array objects{
    Name("bsdf"),    Name("shape"),   Name("emitter"),    Name("sensor"),  Name("film"),
    Name("rfilter"), Name("sampler"), Name("integrator"), Name("texture"), Name("medium"),
    Name("phase"),   Name("volume"),  Name("subsurface")};

} // namespace

std::span<const std::string_view> known_plugins(std::string_view element) {
    if (element == "bsdf")
        return bsdfs;
    if (element == "shape")
        return shapes;
    if (element == "emitter")
        return emitters;
    if (element == "sensor")
        return sensors;
    if (element == "film")
        return films;
    if (element == "rfilter")
        return filters;
    if (element == "sampler")
        return samplers;
    if (element == "integrator")
        return integrators;
    if (element == "texture")
        return textures;
    if (element == "medium")
        return media;
    return {};
}

std::span<const std::string_view> object_elements() { return objects; }

} // namespace plumb
