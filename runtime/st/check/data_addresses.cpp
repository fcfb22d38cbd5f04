#include <charconv>

#include "runtime/source/letters.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/image.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/references.hpp"
#include "runtime/st/types/packed.hpp"

namespace lineshaft::st {

namespace {

struct DataAddress {
    int bits = 0;
    std::uint64_t byte = 0;
};

/// `DBB4`, `DW6`, `%DBD8`, and the byte `DBX2`, which a bit's number stands behind.
std::optional<DataAddress> read_data_address(std::string_view text) {
    if (text.starts_with('%')) text.remove_prefix(1);
    if (text.size() < 3 || upper(text[0]) != 'D') return {};
    text.remove_prefix(upper(text[1]) == 'B' && !is_digit(text[2]) ? 2 : 1);
    constexpr std::string_view letters = "XBWD";
    constexpr int sizes[] = {8, 8, 16, 32};
    const std::size_t kind = letters.find(upper(text[0]));
    if (kind == letters.npos) return {};
    DataAddress read{.bits = sizes[kind]};
    const char* const end = text.data() + text.size();
    const auto [behind, error] = std::from_chars(text.data() + 1, end, read.byte);
    return error == std::errc() && behind == end ? std::optional(read) : std::nullopt;
}

/// Bytes up to the address, then what is there. An array has an even number of bytes.
const Type& seen_at(Checking& c, std::uint64_t byte, const Type& there) {
    Type& bytes = c.make_type(Kind::array, {});
    bytes.element = &bits_type(8);
    bytes.upper = static_cast<std::int64_t>(byte / 2 * 2) - 1;
    Type& made = c.make_type(Kind::structure, {});
    const auto add = [&](std::string_view name, const Type& type) {
        made.members.push_back(&c.make_variable({}, name, &type));
    };
    if (byte > 1) add("before", bytes);
    if (byte % 2 != 0) add("odd", bits_type(8));
    add("there", there);
    return made;
}

/// The bytes that a data block has as a controller has it; 0: some of its parts have none there,
/// which was told.
std::uint64_t size_of_block(Checking& c, const Expression& block, Place at) {
    const std::uint64_t size = packed_bits(*block.type, at.dialect()) / 8;
    if (size == 0)
        c.fail(
            code::not_supported, at,
            fmt::format("'{}' has parts without addresses here, such as a timer", block.token.text),
            "use its variables by their names");
    return size;
}

/// `block`, seen as a value of `type` from its beginning on.
Expression* seen_as(Checking& c, const Expression& like, Expression* block, const Type& type) {
    return make_target(c, like, make_reference_to(c, block, pointer_to(c, type)), &type);
}

/// Takes a number off the text; empty: none stands there.
std::optional<std::uint64_t> take_digits(std::string_view& text) {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) return {};
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

void skip_spaces(std::string_view& text) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
}

int bits_of(const Type& element) {
    return element.kind == Kind::boolean ? 1 : element.bits;
}

/// Several elements have whole words.
struct AnyPointer {
    std::optional<std::uint64_t> block = {};  ///< empty: of `area`
    ImageAddress::Area area = {};
    std::uint64_t byte = 0;
    const Type* element = nullptr;
    std::uint64_t count = 0;
};

/// `DB102.DBX124.0 WORD 2` and `M 100.0 BYTE 4`, in capitals; empty: it is no such.
std::optional<AnyPointer> read_any_pointer(std::string_view text) {
    AnyPointer read;
    skip_spaces(text);
    if (text.starts_with("DB")) {
        text.remove_prefix(2);
        read.block = take_digits(text);
        if (!read.block || !text.starts_with(".DBX")) return {};
        text.remove_prefix(4);
    } else {
        constexpr std::string_view letters = "IQMEA";
        const std::size_t letter = text.empty() ? text.npos : letters.find(text[0]);
        if (letter == text.npos) return {};
        read.area = static_cast<ImageAddress::Area>(letter % 3);
        text.remove_prefix(1);
        skip_spaces(text);
    }
    const auto byte = take_digits(text);
    constexpr std::uint64_t most = 65536;
    if (!byte || *byte > most || !text.starts_with(".0")) return {};
    text.remove_prefix(2);
    skip_spaces(text);
    const std::string_view type = text.substr(0, text.find(' '));
    text.remove_prefix(type.size());
    skip_spaces(text);
    const auto count = take_digits(text);
    read.byte = *byte;
    read.element = find_elementary(type);
    read.count = count.value_or(0);
    const bool is_whole = text.empty() && read.element && read.element->is_scalar();
    if (!is_whole || read.count == 0 || read.count > most) return {};
    const std::uint64_t bits = read.count * static_cast<std::uint64_t>(bits_of(*read.element));
    return read.count == 1 || bits % 16 == 0 ? std::optional(read) : std::nullopt;
}

/// A pointer into a data block becomes a member of what that is seen as.
const Type* check_pointer_to_block(Checking& c, Expression*& e, const AnyPointer& pointer,
                                   const Type& type) {
    const std::string name = fmt::format("DB{}", *pointer.block);
    Expression* block = make_function_name(c, *e, c.checked.names.emplace_back(name));
    block->token.word = Word::name;
    if (!find_variable(c, block->token))
        return c.fail(code::not_declared, e->place,
                      fmt::format("there is no data block with the number {}", *pointer.block),
                      "one of TIA Portal's exports has its number, and so has DATA_BLOCK DB5");
    const std::uint64_t size = check(c, block) ? size_of_block(c, *block, e->place) : 0;
    if (size == 0) return nullptr;
    if (pointer.byte + packed_bits(type, e->place.dialect()) / 8 > size || pointer.byte % 2 != 0)
        return c.fail(
            code::value_out_of_range, e->place, fmt::format("there is no '{}'", e->place.text()),
            pointer.byte % 2 != 0 ? std::string("an array of a data block begins at an even byte")
                                  : fmt::format("'{}' has {} bytes", block->token.text, size));
    e = make_member(c, seen_as(c, *e, block, seen_at(c, pointer.byte, type)), "there");
    return check(c, e);
}

}  // namespace

bool is_any_pointer(std::string_view address) {
    return address.size() > 1 && upper(address[0]) == 'P' && address[1] == '#';
}

const Type* check_any_pointer(Checking& c, Expression*& e) {
    const auto pointer = read_any_pointer(upper(e->token.text.substr(2)));
    if (!pointer)
        return c.fail(code::not_supported, e->place,
                      fmt::format("the pointer '{}' is not supported", e->place.text()),
                      "write P#DB5.DBX10.0 WORD 2 or P#M100.0 BYTE 4, or a variable");
    const bool is_one = pointer->count == 1;
    Type& array = c.make_type(Kind::array, {});
    array.element = pointer->element;
    array.lower = 1;
    array.upper = static_cast<std::int64_t>(pointer->count);
    const Type& type = is_one ? *pointer->element : array;
    if (pointer->block) return check_pointer_to_block(c, e, *pointer, type);
    const ImageAddress address{
        .area = pointer->area,
        .byte = static_cast<std::uint32_t>(pointer->byte),
        .bits = static_cast<std::uint8_t>(is_one ? bits_of(*pointer->element) : 8)};
    e = make_use(c, *e, variable_at(c, e->token, e->token.text, type, address));
    return check(c, e);
}

Expression* bytes_of_block(Checking& c, const Expression& like, Expression* block) {
    const std::uint64_t size = size_of_block(c, *block, like.place);
    if (size == 0) return nullptr;
    Type& bytes = c.make_type(Kind::array, {});
    bytes.element = &bits_type(8);
    bytes.upper = static_cast<std::int64_t>(size) - 1;
    return seen_as(c, like, block, bytes);
}

std::optional<const Type*> check_data_address(Checking& c, Expression*& e) {
    Expression* const block = e->operands[0];
    const bool is_block = block->kind == E::name && block->variable &&
                          block->variable->space == Space::global && e->place.dialect().packs_as_s7;
    const auto address = is_block ? read_data_address(e->token.text) : std::nullopt;
    if (!address) return {};
    const std::uint64_t size = size_of_block(c, *block, e->token.place),
                        end = address->byte + static_cast<std::uint64_t>(address->bits) / 8;
    if (size == 0) return nullptr;
    if (end > size || (address->bits > 8 && address->byte % 2 != 0))
        return c.fail(
            code::value_out_of_range, e->token.place,
            fmt::format("there is no '{}' in '{}'", e->token.text, block->token.text),
            end > size ? fmt::format("it has {} bytes", size) : "words are at even bytes");
    e = make_member(c, seen_as(c, *e, block, seen_at(c, address->byte, bits_type(address->bits))),
                    "there");
    return check(c, e);
}

}  // namespace lineshaft::st
