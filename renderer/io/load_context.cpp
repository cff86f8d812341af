/// \file  Ids, files, warnings and the import report.
#include "renderer/io/load_context.h"

#include "renderer/io/find_file.h"
#include "renderer/io/known_plugins.h"
#include "renderer/io/nearest_name.h"

#include <algorithm>
#include <fmt/format.h>

namespace plumb {

LoadContext::LoadContext(const XmlDocument& document, bool lenient)
    : document_(document), lenient_(lenient) {
    scene.warnings = document.warnings;
    for (const XmlNode& node : document.root.children)
        register_ids(node);
    register_aliases(document.root);
}

void LoadContext::register_ids(const XmlNode& node) {
    const XmlAttribute* id = node.name == "ref" || node.name == "alias" ? nullptr : node.find("id");
    if (id) {
        const auto [place, added] = ids_.emplace(id->value, &node);
        if (!added)
            node.refuse(*id, fmt::format("id '{}' given twice (first at {})", id->value,
                                         to_string(place->second->location())));
    }
    for (const XmlNode& child : node.children)
        register_ids(child);
}

void LoadContext::register_aliases(const XmlNode& root) {
    for (const XmlNode& node : root.children)
        if (node.name == "alias") {
            node.allow_only({"id", "as"});
            const XmlNode& target = target_of(node);
            const XmlAttribute& as = node.require("as");
            if (!ids_.emplace(as.value, &target).second)
                node.refuse(as, fmt::format("id '{}' given twice", as.value));
        }
}

const XmlNode& LoadContext::target_of(const XmlNode& reference) const {
    const XmlAttribute& id = reference.require("id");
    const auto found = ids_.find(id.value);
    if (found != ids_.end())
        return *found->second;
    std::vector<std::string_view> names;
    if (ids_.size() <= 10000) // a suggestion must not take seconds
        for (const auto& [name, node] : ids_)
            names.push_back(name);
    std::sort(names.begin(), names.end()); // the same message in every run
    reference.refuse(id, fmt::format("reference to nothing (got '{}', expected the id of an "
                                     "element){}",
                                     id.value, did_you_mean(id.value, names)));
}

std::filesystem::path LoadContext::file(const XmlNode& node, const XmlAttribute& value) const {
    std::vector<std::filesystem::path> folders{
        std::filesystem::path(node.file->file).parent_path()};
    folders.insert(folders.end(), document_.folders.begin(), document_.folders.end());
    if (const auto found = find_file(value.value, folders))
        return *found;
    throw SceneError(ErrorKind::mesh, node.location(value),
                     fmt::format("file '{}' not found", value.value), node.file->included_from);
}

void LoadContext::warn(const XmlNode& node, const std::string& text) {
    scene.warnings.push_back(to_string(node.location()) + ": warning: " + text);
}

void LoadContext::ignore(const XmlNode& node, const std::string& text) {
    scene.ignored.push_back(to_string(node.location()) + ": " + text);
}

void LoadContext::unsupported(const XmlNode& node, const std::string& what,
                              const std::string& substitute) {
    if (!lenient_)
        node.refuse(what);
    ignore(node, what + "; " + substitute);
}

std::string_view LoadContext::plugin(const XmlNode& node,
                                     std::initializer_list<std::string_view> supported,
                                     const std::string& substitute) {
    const XmlAttribute& type = node.require("type");
    if (std::find(supported.begin(), supported.end(), type.value) != supported.end())
        return type.value;
    std::string list;
    for (const std::string_view name : supported)
        list += (list.empty() ? "" : ", ") + std::string(name);
    const std::span<const std::string_view> known = known_plugins(node.name);
    if (std::find(known.begin(), known.end(), type.value) == known.end())
        node.refuse(type, fmt::format("unknown plugin '{}' ({}){} (supported: {})", type.value,
                                      node.name, did_you_mean(type.value, known), list));
    const std::string what = fmt::format("plugin '{}' ({}) is not supported yet (supported: {})",
                                         type.value, node.name, list);
    if (!lenient_)
        node.refuse(type, what);
    ignore(node, what + "; " + substitute);
    return {};
}

} // namespace plumb
