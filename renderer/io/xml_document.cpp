/// \file  Includes, search paths, defaults and versions.
#include "renderer/io/xml_document.h"

#include "renderer/io/find_file.h"
#include "renderer/io/parse_number.h"
#include "renderer/io/xml_parameters.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <system_error>

namespace plumb {
namespace {

namespace fs = std::filesystem;

class DocumentLoader {
  public:
    DocumentLoader(XmlDocument& document, XmlParameters& parameters)
        : document_(document), parameters_(parameters) {}

    void load(const fs::path& file) {
        document_.folders.push_back(file.parent_path());
        document_.root = read(file, {});
        if (document_.root.name != "scene")
            document_.root.refuse(fmt::format("unknown root element (got <{}>, expected <scene>)",
                                              document_.root.name));
        document_.root.allow_only({"version", "id", "name", "type"});
        check_version(document_.root, true);
        expand_children(document_.root);
        open_files_.pop_back();
    }

  private:
    /// Parses one file and leaves it on the stack of open files.
    XmlNode read(const fs::path& file, const std::vector<SourceLocation>& included_from) {
        document_.files.push_back(read_xml_text(file, included_from));
        open_files_.push_back(fs::weakly_canonical(file));
        return parse_xml(document_.files.back());
    }

    /// Dialects 0.4 to 3.x differ in spelling only, as far as this reader goes.
    void check_version(const XmlNode& scene, bool is_main_file) {
        const XmlAttribute* version = scene.find("version");
        if (!version) {
            if (is_main_file)
                document_.warnings.push_back(to_string(scene.location()) +
                                             ": warning: <scene> without a version (taken as 3.0)");
            return;
        }
        const std::string_view text = version->value;
        const std::size_t dot = text.find('.');
        const auto major = parse_uint32(text.substr(0, dot));
        const std::string_view rest = dot == std::string_view::npos ? "0" : text.substr(dot + 1);
        const auto minor = parse_uint32(rest.substr(0, rest.find('.')));
        const bool supported =
            major && minor && (*major > 0 || *minor >= 4) && *major <= 3 && text[0] != '+';
        if (!supported)
            scene.refuse(*version, fmt::format("unsupported scene version (got '{}', expected "
                                               "0.4 to 3.x)",
                                               text));
    }

    void expand_children(XmlNode& parent) {
        const bool special = std::any_of(parent.children.begin(), parent.children.end(),
                                         [](const XmlNode& n) { return is_directive(n); });
        if (!special) {
            for (XmlNode& child : parent.children)
                expand(child);
            return;
        }
        std::vector<XmlNode> children;
        for (XmlNode& child : parent.children) {
            if (child.name == "default") {
                parameters_.define(child);
            } else if (child.name == "path") {
                parameters_.substitute(child, document_.strings);
                search_path(child);
            } else if (child.name == "include") {
                parameters_.substitute(child, document_.strings);
                include(child, children);
            } else {
                expand(child);
                children.push_back(std::move(child));
            }
        }
        parent.children = std::move(children);
    }

    static bool is_directive(const XmlNode& node) {
        return node.name == "default" || node.name == "path" || node.name == "include";
    }

    void expand(XmlNode& node) {
        parameters_.substitute(node, document_.strings);
        expand_children(node);
    }

    /// Folders for names in `node`'s file: its own first.
    [[nodiscard]] std::vector<fs::path> folders_for(const XmlNode& node) const {
        std::vector<fs::path> folders{fs::path(node.file->file).parent_path()};
        folders.insert(folders.end(), document_.folders.begin(), document_.folders.end());
        return folders;
    }

    void search_path(const XmlNode& element) {
        element.allow_only({"value"});
        const XmlAttribute& value = element.require("value");
        if (const auto folder = find_file(value.value, folders_for(element)))
            document_.folders.insert(document_.folders.begin() + 1, *folder);
        else
            document_.warnings.push_back(fmt::format("{}: warning: <path> '{}' not found",
                                                     to_string(element.location(value)),
                                                     value.value));
    }

    void include(const XmlNode& element, std::vector<XmlNode>& children) {
        element.allow_only({"filename"});
        const XmlAttribute& name = element.require("filename");
        const auto file = find_file(name.value, folders_for(element));
        if (!file)
            element.refuse(name, fmt::format("included file '{}' not found", name.value));
        if (open_files_.size() > max_include_depth)
            element.refuse(name, fmt::format("includes nested too deeply (expected at most {})",
                                             max_include_depth));
        if (document_.files.size() > max_includes)
            element.refuse(name,
                           fmt::format("too many includes (expected at most {})", max_includes));
        const fs::path canonical = fs::weakly_canonical(*file);
        if (std::find(open_files_.begin(), open_files_.end(), canonical) != open_files_.end())
            element.refuse(name, fmt::format("'{}' includes itself", name.value));

        std::vector<SourceLocation> chain{element.location()};
        chain.insert(chain.end(), element.file->included_from.begin(),
                     element.file->included_from.end());
        XmlNode root = read(*file, chain);
        if (root.name == "scene") {
            check_version(root, false);
            expand_children(root);
            std::move(root.children.begin(), root.children.end(), std::back_inserter(children));
        } else {
            expand(root);
            children.push_back(std::move(root));
        }
        open_files_.pop_back();
    }

    XmlDocument& document_;
    XmlParameters& parameters_;
    std::vector<fs::path> open_files_; ///< canonical
};

} // namespace

XmlDocument load_xml_document(const fs::path& file,
                              const std::vector<std::pair<std::string, std::string>>& parameters) {
    XmlDocument document;
    XmlParameters known(parameters);
    DocumentLoader(document, known).load(file);
    for (const std::string& name : known.unused())
        document.warnings.push_back(fmt::format(
            "{}: warning: no '${}' in the scene (-D {} has no effect)", file.string(), name, name));
    return document;
}

} // namespace plumb
