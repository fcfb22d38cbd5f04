#pragma once

#include "runtime/projects/drawings/bodies.hpp"
#include "runtime/projects/project.hpp"
#include "runtime/projects/xml.hpp"

namespace lineshaft::projects {

/// Writes what PLCopen XML has in elements as Structured Text.
class PlcopenText {
  public:
    /// `declared` stays where it is.
    PlcopenText(const XmlFile& file, const DeclaredTypes& declared, bool is_of_matiec)
        : file_(file), declared_(declared), is_of_matiec_(is_of_matiec) {}

    void add_pou(pugi::xml_node pou);
    void add_interface_of_blocks(pugi::xml_node interface);  ///< INTERFACE, an addition of CODESYS
    void add_type(pugi::xml_node type);
    void add_union(pugi::xml_node type);  ///< of CODESYS
    void add_globals(pugi::xml_node list);

    /// What could not be read of it is the text's mistakes, which who compiles it tells.
    std::shared_ptr<const SourceFile> finish(pugi::xml_node named);

  private:
    void write(std::string_view words, pugi::xml_node at) {
        text_.write(words, file_.mark_of_tag(at));
    }
    /// The declaration as text that CODESYS has beside the elements. False: it has none.
    bool add_plain(pugi::xml_node element);
    /// Those that say how names and memory are meant, as pragmas.
    void add_attributes(pugi::xml_node element);
    void add_inheritance(pugi::xml_node element);
    void add_interface(pugi::xml_node interface);
    static std::vector<pugi::xml_node> lists_of(pugi::xml_node section);
    void add_section(pugi::xml_node section, std::string_view word);
    void add_variable(pugi::xml_node variable);
    void add_declared(pugi::xml_node declared, const char* type);
    std::string_view quote_of(pugi::xml_node type, pugi::xml_node value) const;
    void add_type_of(pugi::xml_node type, int depth);
    void add_array(pugi::xml_node array, int depth);
    void add_struct(pugi::xml_node structure, int depth);
    void add_enumeration(pugi::xml_node enumeration);
    void add_subrange(pugi::xml_node subrange, int depth);
    void add_text_type(pugi::xml_node type);
    void add_value(pugi::xml_node value, int depth);
    void add_list(pugi::xml_node values, const char* key, int depth);
    BodyText body_of(pugi::xml_node owner, pugi::xml_node named);
    void add_body(pugi::xml_node owner, pugi::xml_node named);
    void add_own_body(pugi::xml_node owner, pugi::xml_node named);
    void add_variables(const MadeVariables& made, Excerpts rest, pugi::xml_node owner);
    void add_member(pugi::xml_node member);
    void add_property(pugi::xml_node property);
    void add_data(pugi::xml_node owner);

    const XmlFile& file_;
    const DeclaredTypes& declared_;
    Diagnostics out_;
    const bool is_of_matiec_;  ///< see BodyContext
    Excerpts text_;
    std::string pou_;                     ///< whose bodies are read
    MadeVariables* variables_ = nullptr;  ///< of bodies, where they are declared
    bool is_kept_ = true;                 ///< from scan to scan
};

}  // namespace lineshaft::projects
