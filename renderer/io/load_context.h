/// \file  What all parts of the scene loader share.
#pragma once

#include "renderer/io/xml_document.h"
#include "renderer/scene/scene.h"

#include <unordered_map>

namespace plumb {

/// The scene being built, with the ids of the file and the rules for what is not supported.
class LoadContext {
  public:
    /// Registers every id. Throws SceneError for an id given twice.
    LoadContext(const XmlDocument& document, bool lenient);

    Scene scene;

    [[nodiscard]] bool lenient() const { return lenient_; }
    /// The element that a <ref id="..."/> means. Throws SceneError if there is none.
    [[nodiscard]] const XmlNode& target_of(const XmlNode& reference) const;
    /// The file that `value` names. Throws SceneError(mesh) if there is none.
    [[nodiscard]] std::filesystem::path file(const XmlNode& node, const XmlAttribute& value) const;

    /// Adds a line to Scene::warnings or to Scene::ignored, with the element's place.
    void warn(const XmlNode& node, const std::string& text);
    void ignore(const XmlNode& node, const std::string& text);
    /// Something known that this renderer cannot do yet. Strict: throws SceneError(what). Lenient:
    /// adds `what; substitute` to the import report and returns.
    void unsupported(const XmlNode& node, const std::string& what, const std::string& substitute);

    /// The plugin name of an object element (its `type`). Where it is not among `supported`: throws
    /// SceneError, unless lenient and the plugin is known to exist; then reports `substitute`
    /// and returns an empty view.
    [[nodiscard]] std::string_view plugin(const XmlNode& node,
                                          std::initializer_list<std::string_view> supported,
                                          const std::string& substitute);

  private:
    void register_ids(const XmlNode& node);
    void register_aliases(const XmlNode& root);

    const XmlDocument& document_;
    bool lenient_;
    std::unordered_map<std::string_view, const XmlNode*> ids_;
};

} // namespace plumb
