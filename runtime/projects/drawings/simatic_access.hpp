#pragma once

#include "runtime/projects/xml.hpp"

namespace lineshaft::projects {

/// What SimaticML says instead of text: references to variables, constants and blocks, and SCL by
/// its tokens.
class SimaticAccess {
  public:
    explicit SimaticAccess(const XmlFile& file) : file_(file) {}

    /// An `<Access>`: `#motor.speed`, `"Data".list[#i]`, `%MW10`, `T#1s`.
    Excerpts text_of(pugi::xml_node access) const;
    /// An `<Instance>`, or what else has a Scope and Components.
    Excerpts reference(pugi::xml_node scoped) const;
    /// A name in quotes.
    Excerpts quoted(pugi::xml_node named) const;
    /// A label, in quotes where the language has a word of that name: `"FINAL"`.
    Excerpts label(pugi::xml_node named) const;
    /// `<StructuredText>`: statements.
    Excerpts statements(pugi::xml_node tokens) const;

  private:
    void write_tokens(Excerpts& to, pugi::xml_node parent) const;
    void write_token(Excerpts& to, pugi::xml_node token) const;
    void write_components(Excerpts& to, pugi::xml_node symbol, bool is_local) const;
    void write_index(Excerpts& to, pugi::xml_node component) const;
    void write_constant(Excerpts& to, pugi::xml_node constant, bool is_local) const;
    void write_address(Excerpts& to, pugi::xml_node address) const;
    void write_call(Excerpts& to, pugi::xml_node call) const;
    void write_name(Excerpts& to, pugi::xml_node named, bool is_quoted) const;
    Mark place(pugi::xml_node node) const { return file_.mark_of_tag(node); }

    const XmlFile& file_;
};

}  // namespace lineshaft::projects
