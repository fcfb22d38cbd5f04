#include "runtime/projects/xml.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/encoding.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/utf8.hpp"
#include "runtime/source/yaml.hpp"

namespace lineshaft::projects {

namespace {

/// Nothing is changed in the text: neither entities nor the ends of lines.
constexpr unsigned parse_options = pugi::parse_cdata;

struct Entity {
    std::string_view name, text;
};
constexpr Entity entities[] = {
    {"lt", "<"}, {"gt", ">"}, {"amp", "&"}, {"quot", "\""}, {"apos", "'"}};
constexpr std::size_t longest_entity = 12;

/// `&#10;` and `&#x1F600;`, without `&` and `;`. Empty: no character.
std::string numbered_character(std::string_view name) {
    name.remove_prefix(1);
    const bool is_hex = name.starts_with('x');
    if (is_hex) name.remove_prefix(1);
    std::uint32_t code = 0;
    const auto [end, error] =
        std::from_chars(name.data(), name.data() + name.size(), code, is_hex ? 16 : 10);
    const bool is_code = error == std::errc() && end == name.data() + name.size() && code != 0 &&
                         code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF);
    std::string character;
    if (is_code) add_character(character, code);
    return character;
}

/// The character that an entity at the beginning of `text` means, and how many bytes it has; none:
/// an empty one, and 0.
std::pair<std::string, std::size_t> first_entity(std::string_view text) {
    const std::size_t end = text.substr(0, longest_entity).find(';');
    if (end == std::string_view::npos || end < 2) return {};
    const std::string_view name = text.substr(1, end - 1);
    if (name.starts_with('#')) {
        std::string character = numbered_character(name);
        const std::size_t bytes = character.empty() ? 0 : end + 1;
        return {std::move(character), bytes};
    }
    const auto* entity = std::ranges::find(entities, name, &Entity::name);
    if (entity == std::end(entities)) return {};
    return {std::string(entity->text), end + 1};
}

/// Hands over what stands as it is meant, and each character that is written as an entity.
template <class Plain, class Character>
void take_apart(std::string_view text, Plain plain, Character character) {
    std::size_t from = 0;
    for (std::size_t at = text.find('&'); at != text.npos; at = text.find('&', at)) {
        const auto [meant, bytes] = first_entity(text.substr(at));
        if (bytes == 0) {
            ++at;
            continue;
        }
        if (at > from) plain(from, at);
        character(at, at + bytes, meant);
        from = at += bytes;
    }
    if (from < text.size()) plain(from, text.size());
}

/// UTF-16 without a byte order mark is known by its first `<`.
std::string marked_utf16(std::string bytes) {
    using namespace std::string_literals;
    if (bytes.starts_with("<\0"s)) bytes.insert(0, "\xFF\xFE");
    if (bytes.starts_with("\0<"s)) bytes.insert(0, "\xFE\xFF");
    return bytes;
}

std::string_view reason_of(pugi::xml_parse_status status) {
    switch (status) {
        case pugi::status_end_element_mismatch:
            return "this end tag is not that of the element which is open";
        case pugi::status_bad_cdata:
            return "a '<![CDATA[' has no ']]>'";
        case pugi::status_bad_comment:
            return "a comment has no '-->'";
        case pugi::status_bad_attribute:
            return "an attribute is written as name=\"value\"";
        case pugi::status_no_document_element:
            return "it has no element";
        case pugi::status_bad_start_element:
        case pugi::status_unrecognized_tag:
            return "this is no tag";
        default:
            return "it ends, or goes wrong, here";
    }
}

}  // namespace

XmlFile::XmlFile(std::shared_ptr<const SourceFile> source)
    : PlacedFile(std::move(source)), buffer_(text().begin(), text().end()) {
    result_ = document_.load_buffer_inplace(buffer_.data(), buffer_.size(), parse_options,
                                            pugi::encoding_utf8);
}

std::unique_ptr<XmlFile> XmlFile::read(const std::string& path, Diagnostics& out, Mark where,
                                       const XmlLimits& limits) {
    const auto bytes = read_source(path, out, std::move(where), {.bytes = limits.bytes});
    if (!bytes) return nullptr;
    std::string text = as_utf8(marked_utf16(bytes->text));
    if (text.starts_with(utf8_byte_order_mark)) text.erase(0, utf8_byte_order_mark.size());
    return parse(std::make_shared<const SourceFile>(SourceFile{path, std::move(text)}), out,
                 limits);
}

std::unique_ptr<XmlFile> XmlFile::parse(std::shared_ptr<const SourceFile> file, Diagnostics& out,
                                        const XmlLimits& limits) {
    const Mark start{file, 1, 1, 1};
    const auto count = [&](char c) {
        return static_cast<std::size_t>(std::ranges::count(file->text, c));
    };
    const auto refuse = [&](std::size_t limit, std::string_view what) {
        out.add(code::file_too_large, start,
                fmt::format("the file has more than {} {}", limit, what));
        return nullptr;
    };
    if (count('<') > limits.tags) return refuse(limits.tags, "tags");
    if (count('=') > limits.attributes) return refuse(limits.attributes, "attributes");
    if (file->text.starts_with("TcEncryptedFile")) {
        out.add(code::not_xml, start, "this file is encrypted by TwinCAT, as what it belongs to",
                "have its owner take the protection away: TwinCAT's Software Protection");
        return nullptr;
    }
    const std::size_t zero = file->text.find('\0');
    if (zero != std::string::npos) {
        out.add(code::not_xml, PlacedFile(file).mark({zero, zero}), "this file is not a text",
                "save it as XML in UTF-8");
        return nullptr;
    }
    std::unique_ptr<XmlFile> xml(new XmlFile(file));
    if (!xml->result_) {
        const auto at =
            std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(xml->result_.offset, 0)),
                     file->text.size());
        out.add(code::not_xml, xml->mark({at, at}),
                fmt::format("this file is not XML: {}", reason_of(xml->result_.status)),
                "export or save it anew; a file that was cut short or merged has lost a part");
        return nullptr;
    }
    return xml;
}

void XmlFile::remove_prefix() {
    const std::string_view name = root().name();
    const std::size_t colon = name.find(':');
    if (colon == name.npos) return;
    struct Renaming : pugi::xml_tree_walker {
        std::string prefix;

        bool for_each(pugi::xml_node& node) override {
            const std::string written = node.name();
            if (written.starts_with(prefix)) node.set_name(written.substr(prefix.size()).c_str());
            return true;
        }
    } renaming;
    renaming.prefix = prefix_ = name.substr(0, colon + 1);
    root().traverse(renaming);
    pugi::xml_node whole = root();
    renaming.for_each(whole);
}

Part XmlFile::tag(pugi::xml_node element) const {
    const auto begin = static_cast<std::size_t>(element.offset_debug());
    const bool has_prefix = !prefix_.empty() && text().substr(begin).starts_with(prefix_);
    const std::size_t name = begin + (has_prefix ? prefix_.size() : 0);
    return {name - 1, name + std::strlen(element.name())};
}

/// A value that is not there is no place in the buffer.
Part XmlFile::part_of(const char* value) const {
    const std::less<> before;
    const char* const begin = buffer_.data();
    if (before(value, begin) || !before(value, begin + buffer_.size())) return {};
    const auto at = static_cast<std::size_t>(value - begin);
    return {at, at + std::strlen(value)};
}

std::vector<Part> XmlFile::texts(pugi::xml_node element) const {
    std::vector<Part> parts;
    for (pugi::xml_node node = element.first_child(); node;) {
        if (node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata)
            parts.push_back(part_of(node.value()));
        if (node.first_child()) {
            node = node.first_child();
            continue;
        }
        while (node && node != element && !node.next_sibling()) node = node.parent();
        if (!node || node == element) break;
        node = node.next_sibling();
    }
    return parts;
}

std::string XmlFile::plain(Part part) const {
    std::string meant;
    const std::string_view written = text(part);
    take_apart(
        written,
        [&](std::size_t begin, std::size_t end) { meant += written.substr(begin, end - begin); },
        [&](std::size_t, std::size_t, const std::string& character) { meant += character; });
    return meant;
}

std::string XmlFile::plain(pugi::xml_node element) const {
    std::string meant;
    for (const Part part : texts(element)) meant += plain(part);
    return std::string(trimmed(meant, " \t\r\n"));
}

void XmlFile::copy(Excerpts& to, Part part) const {
    const auto inner = [&](std::size_t begin, std::size_t end) {
        return Part{part.begin + begin, part.begin + end};
    };
    take_apart(
        text(part), [&](std::size_t begin, std::size_t end) { to.copy(*this, inner(begin, end)); },
        [&](std::size_t begin, std::size_t end, const std::string& character) {
            to.write(character, mark(inner(begin, end)));
        });
}

/// An entity in CDATA is none.
void XmlFile::copy(Excerpts& to, pugi::xml_node element) const {
    for (const Part part : texts(element)) {
        const bool is_cdata = text().substr(0, part.begin).ends_with("<![CDATA[");
        if (is_cdata)
            to.copy(*this, part);
        else
            copy(to, part);
    }
}

}  // namespace lineshaft::projects
