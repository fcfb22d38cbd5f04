#include "runtime/st/check/image.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/source/letters.hpp"
#include "runtime/st/check/s5.hpp"
#include "runtime/st/syntax/literals.hpp"
#include "runtime/st/types/packed.hpp"
#include "runtime/st/types/s5.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

namespace {

/// As the dialect writes it; what begins between two of its size, by its first byte.
std::string text_in(const Dialect& dialect, ImageAddress address) {
    const bool counts_bytes = dialect.addresses_count == AddressCount::bytes;
    if (!counts_bytes && address.bits > 8 && address.byte % (address.bits / 8U) != 0)
        address.bits = 8;
    return text_of(address, dialect.addresses_count);
}

constexpr std::uint32_t first_point = longest_area / 2, bytes_of_point = 8;

/// `%QW9.24.0` and `%QX9.24.0.3` are of one point of a bus, which stands behind all that a
/// controller has of its own: each has bytes there, in the order in which they are named.
std::optional<ImageAddress> point_of(Checking& c, std::string_view text) {
    const std::size_t last = text.rfind('.');
    const bool is_bit = text.size() > 2 && upper(text[2]) == 'X';
    const std::size_t first = text.find_first_of("0123456789");
    if (std::ranges::count(text, '.') < (is_bit ? 3 : 2) || first == text.npos) return {};
    auto address = read_address(fmt::format("{}0{}", text.substr(0, first),
                                            is_bit ? text.substr(last) : std::string_view()),
                                AddressCount::words);
    if (!address) return {};
    std::string name(text.substr(first, is_bit ? last - first : text.npos));
    name.insert(name.begin(), upper(text[1]));
    const auto next = static_cast<std::uint32_t>(first_point + bytes_of_point * c.points.size());
    address->byte += c.points.emplace(std::move(name), next).first->second;
    return address->end() <= longest_area ? address : std::nullopt;
}

std::optional<ImageAddress> address_of(Checking& c, const Token& token) {
    const AddressCount count = token.place.dialect().addresses_count;
    const auto address = token.text.starts_with('%') ? read_address(token.text, count)
                                                     : read_classic_address(token.text);
    if (address && address->end() <= longest_area) return address;
    if (token.place.dialect().image_has_points)
        if (const auto point = point_of(c, token.text)) return point;
    if (!address) {
        const std::string_view instead = instead_of_address(token.text);
        c.fail(code::not_declared, token.place, fmt::format("'{}' is not an address", token.text),
               std::string(!instead.empty() ? instead
                                            : "write the area I, Q or M, the size X, B, W, D or L, "
                                              "and the byte: %IX0.3, %QW4, %MD8"));
        return {};
    }
    c.fail(code::value_out_of_range, token.place,
           fmt::format("'{}' is beyond its area", token.text),
           fmt::format("its bytes are 0 to {}", longest_area - 1));
    return {};
}

const Type& type_at(const ImageAddress& address) {
    return address.bits == 1 ? bool_type : bits_type(address.bits);
}

Image& image_of(Checking& c, const Place& at) {
    Image& image = c.checked.image;
    if (image.global < 0) {
        image.global = static_cast<int>(c.checked.globals.size());
        image.sizes_are_apart = at.dialect().addresses_count == AddressCount::sizes_apart;
        c.checked.globals.push_back({std::string(image_name), &c.make_type(Kind::structure, "")});
    }
    return image;
}

void put(Checking& c, Variable& variable, const ImageAddress& address) {
    Image& image = image_of(c, variable.name.place);
    variable.space = Space::image;
    variable.global = image.global;
    variable.address = address;
    image.variables.push_back(&variable);
}

/// CODESYS begins a number of any size at a byte, and has a BOOL that is no bit of its own in the
/// first bit of it. False: the prefix is of another size, and this was told.
bool takes_size(Checking& c, const Variable& variable, ImageAddress& address, const Token& at) {
    const Type& type = *variable.type;
    const bool is_bit = type.kind == Kind::boolean;
    const std::uint64_t bits = is_bit ? 1 : packed_bits(type, at.place.dialect());
    if (type.is_scalar() ? bits == address.bits : address.bits != 1) return true;
    const std::string what =
        fmt::format("'{}' is of {}, and {} has {} bit{}", variable.text, describe(type), at.text,
                    static_cast<int>(address.bits), address.bits == 1 ? "" : "s");
    const std::string_view help =
        "X is of BOOL, B of 8 bits, W of 16, D of 32, L of 64; arrays and structures begin at a "
        "byte";
    const Dialect& dialect = at.place.dialect();
    const bool is_apart = dialect.addresses_count == AddressCount::sizes_apart;
    if (address.bits == 1 || !dialect.is_loose || is_apart)
        return c.fail(code::type_does_not_fit, at.place, what, std::string(help));
    c.warn(code::type_does_not_fit, at.place, what, std::string(help));
    address.bits = static_cast<std::uint8_t>(bits);
    return true;
}

/// A part of it is wrong, which was told.
bool has_unknown(const Type* type) {
    if (!type) return true;
    if (type->kind == Kind::array) return has_unknown(type->element);
    const auto is_unknown = [](const Variable* member) { return has_unknown(member->type); };
    return type->kind == Kind::structure && std::ranges::any_of(type->members, is_unknown);
}

/// The area has all bits that the variable has.
bool fits(Checking& c, const Variable& variable, ImageAddress& address, const Token& at) {
    const Type& type = *variable.type;
    const std::uint64_t bits = packed_bits(type, at.place.dialect());
    if (bits == 0 && has_unknown(&type)) return false;
    if (bits == 0)
        return c.fail(code::type_does_not_fit, at.place,
                      fmt::format("{} stands at no address", describe(type)),
                      "numbers, times, texts, and structures and arrays of such do");
    if (!takes_size(c, variable, address, at)) return false;
    if (address.byte + (bits + 7) / 8 <= longest_area) return true;
    return c.fail(code::value_out_of_range, at.place,
                  fmt::format("'{}' ends beyond its area", variable.text),
                  fmt::format("its bytes are 0 to {}", longest_area - 1));
}

/// In bits of its area, from the first on.
std::pair<std::uint64_t, std::uint64_t> range_of(const Variable& variable) {
    const ImageAddress& at = variable.address;
    const std::uint64_t first = std::uint64_t{8} * at.byte + at.bit;
    const bool is_bit = at.bits == 1;
    return {first,
            first + (is_bit ? 1 : packed_bits(*variable.type, variable.name.place.dialect()))};
}

bool cross(const Image& image, const Variable& a, const Variable& b) {
    if (image.part_of(a.address) != image.part_of(b.address)) return false;
    const auto [first, first_end] = range_of(a);
    const auto [second, second_end] = range_of(b);
    if (first >= second_end || second >= first_end) return false;
    const bool is_same = first == second && first_end == second_end;
    const bool holds = (first <= second && first_end >= second_end) ||
                       (second <= first && second_end >= first_end);
    return is_same || !holds;
}

void warn_of_crossing(Checking& c, const Image& image) {
    std::vector<const Variable*> declared;
    for (const Variable* variable : image.variables)
        if (!variable->is_direct) declared.push_back(variable);
    std::ranges::stable_sort(declared, {}, [](const Variable* v) { return range_of(*v); });
    constexpr std::size_t most_neighbours = 64;
    for (std::size_t i = 0; i < declared.size(); ++i)
        for (std::size_t k = i + 1; k < std::min(declared.size(), i + most_neighbours); ++k) {
            if (!cross(image, *declared[i], *declared[k])) continue;
            const Dialect& dialect = declared[k]->name.place.dialect();
            c.warn(code::addresses_overlap, declared[k]->name.place,
                   fmt::format("'{}' at {} has bytes of '{}' at {}", declared[k]->text,
                               text_in(dialect, declared[k]->address), declared[i]->text,
                               text_in(dialect, declared[i]->address)),
                   dialect.addresses_count == AddressCount::bytes
                       ? "addresses count bytes: behind %MW0 comes %MW2"
                       : "%MD0 has the words %MW0 and %MW1");
            break;
        }
}

/// As all sources that name an address count, else bytes.
AddressCount count_of(const Image& image) {
    const auto count = [](const Variable* v) { return v->name.place.dialect().addresses_count; };
    const AddressCount first = count(image.variables.front());
    const bool is_one =
        std::ranges::all_of(image.variables, [&](const Variable* v) { return count(v) == first; });
    return is_one ? first : AddressCount::bytes;
}

/// What it takes and gives stands in the image then, and is wired there.
bool is_of_program(const Checking& c, const Variable& variable) {
    const Section section = variable.section;
    return c.routine && c.routine->pou->kind == PouKind::program &&
           (section == Section::input || section == Section::output || section == Section::global);
}

/// A UNION has bytes as they are.
const Type& type_of_pointers(Checking& c, const Image& image) {
    Type& bytes = c.make_type(Kind::array, {});
    bytes.upper = std::int64_t{image.bytes} - 1;
    bytes.element = &bits_type(8);
    Type& all = c.make_type(Kind::union_, std::string(image_name));
    all.members = {&c.make_variable(image.variables.front()->name, "bytes", &bytes)};
    return all;
}

}  // namespace

bool is_left_open(const Token& at, Variable& variable) {
    if (!at.text.ends_with('*')) return false;
    const char area = at.text.size() > 2 ? upper(at.text[1]) : ' ';
    if (area == 'I') variable.pin = Section::input;
    if (area == 'Q') variable.pin = Section::output;
    return true;
}

void locate_in_image(Checking& c, Variable& variable, const Declaration& declared) {
    const Token& at = declared.at;
    if (at.word != Word::direct || !variable.type) return;
    variable.used = true;
    if (is_s5_number(variable.type)) {
        if (!locate_s5(c, variable, at)) variable.type = nullptr;
        return;
    }
    if (is_left_open(at, variable)) return;
    auto address = address_of(c, at);
    const bool begins_byte = address && address->bits == 1 && address->bit == 0;
    if (begins_byte && !variable.type->is_scalar() && at.place.dialect().packs_as_s7)
        address->bits = 8;
    if (!address || !fits(c, variable, *address, at)) return void(variable.type = nullptr);
    const bool stays = !c.routine || c.routine->has_instances();
    if (is_of_program(c, variable)) variable.section = Section::local;
    if (variable.section == Section::local && stays) return put(c, variable, *address);
    c.fail(code::wrong_place, at.place,
           "AT is for VAR and VAR_GLOBAL of what stays, and for a PROGRAM's inputs and outputs",
           "declare it there, or write the address in the body");
}

/// What a memory has at an address is written and packed alike in sources of one dialect alone.
static bool is_seen_alike(const Variable& direct, const Place& place) {
    return &direct.name.place.dialect() == &place.dialect();
}

const Type* check_direct(Checking& c, Expression& e) {
    const auto address = address_of(c, e.token);
    if (!address) return nullptr;
    Image& image = image_of(c, e.place);
    const auto is_there = [&](const Variable* variable) {
        return variable->is_direct && variable->type->is_scalar() &&
               variable->address == *address && is_seen_alike(*variable, e.place);
    };
    const auto it = std::ranges::find_if(image.variables, is_there);
    if (it != image.variables.end()) {
        e.variable = *it;
        return e.variable->type;
    }
    Variable& variable =
        c.make_variable(e.token, c.checked.names.emplace_back(text_in(e.place.dialect(), *address)),
                        &type_at(*address));
    variable.is_direct = variable.used = true;
    put(c, variable, *address);
    e.variable = &variable;
    return variable.type;
}

Variable& variable_at(Checking& c, const Token& at, std::string_view name, const Type& type,
                      const ImageAddress& address) {
    for (Variable* known : image_of(c, at.place).variables)
        if (known->text == name && is_seen_alike(*known, at.place)) return *known;
    Variable& made = c.make_variable(at, name, &type);
    made.is_direct = made.used = made.is_set = true;
    put(c, made, address);
    return made;
}

Variable& bytes_of_area(Checking& c, const Token& at, ImageAddress::Area area) {
    constexpr std::string_view names[areas] = {"%IB0..%IB1023", "%QB0..%QB1023", "%MB0..%MB1023"};
    Type& array = c.make_type(Kind::array, {});
    array.upper = 1023;
    array.element = &bits_type(8);
    return variable_at(c, at, names[static_cast<std::size_t>(area)], array,
                       {.area = area, .bits = 8});
}

void finish_image(Checking& c) {
    Image& image = c.checked.image;
    if (image.global < 0) return;
    std::uint64_t sizes[Image::parts] = {};
    for (const Variable* variable : image.variables) {
        std::uint64_t& size = sizes[image.part_of(variable->address)];
        size = std::max(size, (range_of(*variable).second + 7) / 8);
    }
    image.count = count_of(image);
    for (const std::string& text : c.tree.addresses)
        for (const ImageAddress& address : addresses_of_range(text, image.count)) {
            image.named.push_back(address);
            std::uint64_t& size = sizes[image.part_of(address)];
            size = std::max<std::uint64_t>(size, address.end());
        }
    constexpr std::uint64_t behind_what_is_named = 1024;
    std::uint64_t at = 0;
    for (std::size_t part = 0; part < Image::parts; ++part) {
        if (c.checked.is_referred[part]) sizes[part] += behind_what_is_named;
        image.begins[part] = static_cast<std::uint32_t>(at);
        at += (sizes[part] + 7) / 8 * 8;
    }
    image.bytes = static_cast<std::uint32_t>(at);
    const_cast<Type&>(*c.checked.globals[static_cast<std::size_t>(image.global)].type).slots =
        static_cast<std::uint32_t>(at / 8);
    if (std::ranges::find(c.checked.is_referred, true) != std::end(c.checked.is_referred))
        c.checked.bytes_of_image = &type_of_pointers(c, image);
    warn_of_crossing(c, image);
}

}  // namespace lineshaft::st
