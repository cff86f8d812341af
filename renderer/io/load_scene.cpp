/// \file  From the root of a scene file to its parts.
#include "renderer/io/load_scene.h"

#include "renderer/io/known_plugins.h"
#include "renderer/io/load_emitter.h"
#include "renderer/io/load_integrator.h"
#include "renderer/io/load_material.h"
#include "renderer/io/load_sensor.h"
#include "renderer/io/load_shape.h"
#include "renderer/io/nearest_name.h"

#include <algorithm>
#include <fmt/format.h>
#include <string_view>

namespace plumb {
namespace {

class SceneLoader {
  public:
    explicit SceneLoader(const XmlDocument& document, bool lenient)
        : root_(document.root), context_(document, lenient), materials_(context_),
          shapes_(context_, materials_) {}

    Scene load() {
        for (const XmlNode& child : root_.children)
            element(child);
        shapes_.finish();
        conclude();
        return std::move(context_.scene);
    }

  private:
    void element(const XmlNode& node) {
        if (node.name == "sensor")
            sensor(node);
        else if (node.name == "integrator")
            integrator(node);
        else if (node.name == "bsdf")
            static_cast<void>(materials_.sides(node));
        else if (node.name == "shape")
            shapes_.load(node);
        else if (node.name == "emitter")
            emitters_ += load_emitter(context_, node) ? 1 : 0;
        else if (node.name == "ref")
            reference(node);
        else if (node.name != "alias")
            other(node);
    }

    void sensor(const XmlNode& node) {
        if (sensor_) {
            context_.warn(node, fmt::format("second sensor (the first, at {}, is used)",
                                            to_string(sensor_->location())));
            return;
        }
        sensor_ = &node;
        load_sensor(context_, node);
    }

    void integrator(const XmlNode& node) {
        if (integrator_)
            node.refuse(fmt::format("second integrator (expected one, first at {})",
                                    to_string(integrator_->location())));
        integrator_ = &node;
        load_integrator(context_, node);
    }

    /// A reference at the top level repeats nothing: what it means stands in the scene already.
    void reference(const XmlNode& node) {
        const XmlNode& target = context_.target_of(node);
        context_.unsupported(
            node, fmt::format("<ref> to <{}> at the top level is not supported", target.name),
            "left out");
    }

    void other(const XmlNode& node) {
        const auto objects = object_elements();
        if (std::find(objects.begin(), objects.end(), node.name) == objects.end())
            node.refuse(fmt::format("unknown element <{}> in <scene>{}", node.name,
                                    did_you_mean(node.name, objects)));
        const std::string_view type = node.value_or_empty("type");
        context_.unsupported(
            node,
            type.empty() ? fmt::format("<{}> in <scene> is not supported", node.name)
                         : fmt::format("plugin '{}' ({}) is not supported yet", type, node.name),
            "left out");
    }

    void conclude() {
        if (!sensor_)
            context_.warn(root_, "no sensor (a default camera at the origin looks along +z)");
        const Scene& scene = context_.scene;
        const bool glows = std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                                       [](const Surface& s) { return !is_black(s.emission); });
        if (!glows && emitters_ == 0)
            context_.warn(root_, "no emitter (the image will be black)");
        if (scene.meshes.empty() && scene.spheres.empty())
            context_.warn(root_, "no shape");
    }

    const XmlNode& root_;
    LoadContext context_;
    MaterialLoader materials_;
    ShapeLoader shapes_;
    const XmlNode* sensor_ = nullptr;
    const XmlNode* integrator_ = nullptr;
    int emitters_ = 0; ///< beside those of shapes
};

} // namespace

Scene load_scene(const LoadOptions& options) {
    const XmlDocument document = load_xml_document(options.file, options.parameters);
    return SceneLoader(document, options.lenient).load();
}

} // namespace plumb
