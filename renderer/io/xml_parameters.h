/// \file  `$parameter` in attribute values.
#pragma once

#include "renderer/io/xml_node.h"

#include <deque>
#include <map>
#include <string>
#include <utility>

namespace plumb {

/// The parameters of a scene: from the command line and from <default> elements. A parameter of the
/// command line wins over <default>; of two defaults the first wins.
class XmlParameters {
  public:
    /// `from_command_line`: name and value; of two with one name the last wins.
    explicit XmlParameters(
        const std::vector<std::pair<std::string, std::string>>& from_command_line);

    /// Takes a <default name value> element. Throws SceneError.
    void define(const XmlNode& element);
    /// Replaces every `$name` (letters, digits, _) in the values of the element's attributes.
    /// `pool` owns the new texts. Throws SceneError where a parameter is not defined.
    void substitute(XmlNode& node, std::deque<std::string>& pool);
    /// Names given on the command line that no attribute asked for.
    [[nodiscard]] std::vector<std::string> unused() const;

  private:
    struct Parameter {
        std::string value;
        bool from_command_line = false, used = false;
    };
    std::string expanded(const XmlNode& node, const XmlAttribute& attribute);

    std::map<std::string, Parameter, std::less<>> parameters_;
};

} // namespace plumb
