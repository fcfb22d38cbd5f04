#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

#include "runtime/projects/excerpts.hpp"

namespace lineshaft::projects {

/// What an XML file may have. Beyond the size it is not read, beyond the others not parsed.
struct XmlLimits {
    std::size_t bytes = 16U << 20;
    std::size_t tags = 1'000'000;        ///< '<', in texts too
    std::size_t attributes = 1'000'000;  ///< '=', in texts too
};

/// An XML file as a tree whose texts know where they stand. Any of UTF-8, UTF-16 and Windows-1252
/// is read, whatever its declaration says. Entities are those five of XML and numbers: a document
/// type is passed over, so nothing that it defines grows.
class XmlFile : public PlacedFile {
  public:
    /// Empty, and what is wrong told in `out`:
    ///   L0001, L0106  as read_source()
    ///   L0110  not XML: the place is where it cannot go on
    static std::unique_ptr<XmlFile> read(const std::string& path, Diagnostics& out, Mark where = {},
                                         const XmlLimits& limits = {});

    /// The same of a text that is read already.
    static std::unique_ptr<XmlFile> parse(std::shared_ptr<const SourceFile> file, Diagnostics& out,
                                          const XmlLimits& limits = {});

    pugi::xml_node root() const { return document_.document_element(); }

    /// Where the root has one, `<ppx:project>`: all names of that prefix lose it, and those of
    /// other namespaces keep theirs.
    void remove_prefix();

    /// The element's name and the character before it, which is `<` where it has no prefix.
    Part tag(pugi::xml_node element) const;
    Mark mark_of_tag(pugi::xml_node element) const { return mark(tag(element)); }
    /// As it is written, with its entities; an empty part: there is none.
    Part part(pugi::xml_attribute attribute) const { return part_of(attribute.value()); }
    /// The text and CDATA below an element, in the order of the file.
    std::vector<Part> texts(pugi::xml_node element) const;

    /// Without entities.
    std::string plain(Part part) const override;
    std::string plain(pugi::xml_attribute attribute) const { return plain(part(attribute)); }
    /// All text below, without entities and blanks around it.
    std::string plain(pugi::xml_node element) const;

    /// Copies a part, its entities as the characters that they are.
    void copy(Excerpts& to, Part part) const override;
    void copy(Excerpts& to, pugi::xml_attribute attribute) const { copy(to, part(attribute)); }
    /// All text below.
    void copy(Excerpts& to, pugi::xml_node element) const;

  private:
    explicit XmlFile(std::shared_ptr<const SourceFile> file);
    Part part_of(const char* value) const;

    std::vector<char> buffer_;  ///< the text, in which the parser has put its ends
    pugi::xml_document document_;
    std::string prefix_;
    pugi::xml_parse_result result_;
};

}  // namespace lineshaft::projects
