#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/projects/xml.hpp"

namespace lineshaft::projects {

/// What an operand, an input or a tree of a network is marked with.
struct Marks {
    bool is_negated = false, is_set = false;  ///< both: reset
    bool is_jump = false, is_return = false;
    bool is_rising = false, is_falling = false;
};

/// An `<XmlArchive>` of TwinCAT: objects `<o>`, values `<v>`, lists `<l2>`, and `<n />` for
/// nothing. `n` names a member, `t` the kind of an object; a list says it once (`cet`) where all
/// are the same.
class Archive {
  public:
    explicit Archive(const XmlFile& file) : file_(file) {}

    /// The one object of the body `<NWL>` and its like.
    static pugi::xml_node root(pugi::xml_node body) {
        return body.child("XmlArchive").child("Data").child("o");
    }
    /// The object's member of that name.
    static pugi::xml_node member(pugi::xml_node object, std::string_view name);
    /// What is in a list, `<n />` too.
    static std::vector<pugi::xml_node> items(pugi::xml_node list);
    /// `<n />`, or not there.
    static bool is_null(pugi::xml_node object);
    static std::string_view kind_of(pugi::xml_node object);

    /// A value, without the quotes around a text.
    std::string text(pugi::xml_node object, std::string_view name) const;
    bool is_true(pugi::xml_node object, std::string_view name) const;
    std::vector<std::string> strings(pugi::xml_node object, std::string_view name) const;
    /// What the object's `Flags` say.
    Marks marks_of(pugi::xml_node object) const { return marks_in(member(object, "Flags")); }
    Marks marks_in(pugi::xml_node flags) const;

    const XmlFile& file() const { return file_; }

  private:
    const XmlFile& file_;
};

}  // namespace lineshaft::projects
