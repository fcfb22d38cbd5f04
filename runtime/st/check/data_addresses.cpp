#include <charconv>

#include "runtime/source/letters.hpp"
#include "runtime/st/check/expressions.hpp"
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
const Type& seen_at(Checking& c, const DataAddress& address) {
    Type& bytes = c.make_type(Kind::array, {});
    bytes.element = &bits_type(8);
    bytes.upper = static_cast<std::int64_t>(address.byte / 2 * 2) - 1;
    Type& made = c.make_type(Kind::structure, {});
    const auto add = [&](std::string_view name, const Type& type) {
        made.members.push_back(&c.make_variable({}, name, &type));
    };
    if (address.byte > 1) add("before", bytes);
    if (address.byte % 2 != 0) add("odd", bits_type(8));
    add("there", bits_type(address.bits));
    return made;
}

}  // namespace

std::optional<const Type*> check_data_address(Checking& c, Expression*& e) {
    Expression* const block = e->operands[0];
    const bool is_block = block->kind == E::name && block->variable &&
                          block->variable->space == Space::global && e->place.dialect().packs_as_s7;
    const auto address = is_block ? read_data_address(e->token.text) : std::nullopt;
    if (!address) return {};
    const std::uint64_t size = packed_bits(*block->type, e->place.dialect()),
                        end = 8 * address->byte + static_cast<std::uint64_t>(address->bits);
    if (end > size || (address->bits > 8 && address->byte % 2 != 0))
        return c.fail(
            code::value_out_of_range, e->token.place,
            fmt::format("there is no '{}' in '{}'", e->token.text, block->token.text),
            end > size ? fmt::format("it has {} bytes", size / 8) : "words are at even bytes");
    const Type& type = seen_at(c, *address);
    Expression* view = make_target(c, *e, make_reference_to(c, block, pointer_to(c, type)), &type);
    e = make_member(c, view, "there");
    return check(c, e);
}

}  // namespace lineshaft::st
