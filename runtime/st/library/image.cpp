#include <cstring>
#include <limits>
#include <set>

#include "runtime/model/kept_state.hpp"
#include "runtime/st/library/fields.hpp"
#include "runtime/st/types/elementary.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;

/// A value has two slots behind the bytes: what others see, and what that was when it was last the
/// same as in the bytes.
std::byte* shown(const ImageKind& kind, std::byte* block, std::size_t i) {
    return block + kind.bytes + 16 * i;
}

/// True where somebody has written what others see.
bool has_changed(const std::byte* place) {
    return std::memcmp(place, place + 8, 8) != 0;
}

bool show(std::byte* first, std::size_t, const Scan&, const Context& context) {
    const auto& kind = *static_cast<const ImageKind*>(context.kind);
    for (std::size_t i = 0; i < kind.places.size(); ++i) {
        const std::uint64_t value = load_packed(first, kind.places[i].bit, kind.places[i].format);
        std::memcpy(shown(kind, first, i), &value, sizeof value);
        std::memcpy(shown(kind, first, i) + 8, &value, sizeof value);
    }
    return false;
}

bool take_in(std::byte* first, std::size_t count, const Scan& now, const Context& context) {
    const auto& kind = *static_cast<const ImageKind*>(context.kind);
    for (std::size_t i = 0; i < kind.places.size(); ++i) {
        const std::byte* place = shown(kind, first, i);
        if (has_changed(place))
            store_packed(first, kind.places[i].bit, kind.places[i].format,
                         read<std::uint64_t>(place));
    }
    return show(first, count, now, context);
}

bool stand_still(std::byte*, std::size_t, const Scan&, const Context&) {
    return false;
}

void make_image(std::byte* place, const void* context) {
    const auto& kind = *static_cast<const ImageKind*>(context);
    if (kind.bytes > 0) std::memcpy(place, kind.image, kind.bytes);
    show(place, 1, {}, {.kind = context});
}

bool image_is_valid(const std::byte* block, const KeptState& machine) {
    const auto& kind = *static_cast<const ImageKind*>(machine.context.kind);
    for (std::size_t i = 0; i < kind.places.size(); ++i) {
        const std::byte* place = block + kind.bytes + 16 * i;
        const bool is_boolean = kind.places[i].format.coding == PackedFormat::Coding::bit;
        if (is_boolean && (read<std::uint64_t>(place) > 1 || read<std::uint64_t>(place + 8) > 1))
            return false;
    }
    return true;
}

Direction direction_of(ImageAddress::Area area) {
    return area == ImageAddress::Area::input    ? Direction::input
           : area == ImageAddress::Area::output ? Direction::output
                                                : Direction::local;
}

Field field_of(const Type& type, const ImageAddress& address) {
    Field field;
    field.direction = direction_of(address.area);
    field.type = type.kind == Kind::boolean ? lineshaft::Type::boolean
                 : type.is_real()           ? lineshaft::Type::real
                 : type.is_unsigned_64()    ? lineshaft::Type::unsigned_integer
                                            : lineshaft::Type::integer;
    if (type.is_time()) field.unit = "ns";
    const bool is_number = type.kind == Kind::integer || type.kind == Kind::bits;
    if (type.is_unsigned_64()) {
        field.minimum = 0;
    } else if (is_number && type.bits < 64) {
        field.minimum = static_cast<double>(smallest(type));
        field.maximum = static_cast<double>(largest(type));
    } else if (type.is_real() && type.bits == 32) {
        field.maximum = std::numeric_limits<float>::max();
        field.minimum = -field.maximum;
    }
    return field;
}

/// A variable that sources write has a byte in common with it, or the same bits.
bool is_set_by_sources(const Image& image, const ImageAddress& address) {
    const std::uint64_t first = image.bit_of(address), end = first + address.bits;
    return std::ranges::any_of(image.variables, [&](const Variable* variable) {
        if (!variable->is_set) return false;
        const Dialect& dialect = variable->name.place.dialect();
        const std::uint64_t begin = image.bit_of(variable->address);
        const std::uint64_t bits =
            variable->address.bits == 1 ? 1 : packed_bits(*variable->type, dialect);
        return begin < end && first < begin + bits;
    });
}

/// Gives an address its field, of the first variable that is there.
class Fields {
  public:
    Fields(Library::Made& made, const Image& image) : made_(made), image_(image) {}

    void add(const ImageAddress& address, const Type& type, const Dialect& dialect,
             const Variable* variable) {
        const std::string name = text_of(address, image_.count);
        if (!seen_.insert(name).second) return;
        ImageKind& kind = made_.image;
        PackedFormat format{PackedFormat::Coding::bit, 1, false, 0};
        if (address.bits > 1) format = packed_format(type, dialect).value();
        const bool is_set =
            address.area == ImageAddress::Area::output && is_set_by_sources(image_, address);
        kind.places.push_back({image_.bit_of(address), format});
        Field field = field_of(type, address);
        field.name = made_.names.emplace_back(name);
        field.offset = kind.bytes + 16 * (kind.places.size() - 1);
        if (variable && !variable->is_direct) {
            field.doc =
                made_.names.emplace_back(variable->doc.empty() ? std::string(variable->text)
                                                               : text_of_comments(variable->doc));
            if (!type.is_time()) field.unit = variable->unit;
        }
        kind.fields.push_back(field);
        if (is_set || field.direction == Direction::input) return;
        field.direction = Direction::input;
        kind.fields.push_back(field);
    }

  private:
    Library::Made& made_;
    const Image& image_;
    std::set<std::string> seen_;
};

}  // namespace

AddressCount count_of_addresses(const BlockType& image) {
    return static_cast<const ImageKind*>(image.context)->count;
}

BlockType image_type(Library::Made& made, const std::shared_ptr<const Library::Made>& owner,
                     const Global& global) {
    const Image& image = made.checked.image;
    made.image.bytes = image.bytes;
    made.image.image = made.generated.images.at(global.type).data();
    Fields fields(made, image);
    for (const bool is_direct : {false, true})
        for (const Variable* variable : image.variables)
            if (variable->is_direct == is_direct && variable->type->is_scalar())
                fields.add(variable->address, *variable->type, variable->name.place.dialect(),
                           variable);
    const Dialect& dialect = image.variables.front()->name.place.dialect();
    for (const ImageAddress& address : image.named)
        fields.add(address, address.bits == 1 ? bool_type : bits_type(address.bits), dialect,
                   nullptr);
    BlockType type;
    made.image.count = image.count;
    type.name = image_name;
    type.doc = "process image";
    type.fields = made.image.fields;
    type.size = made.image.bytes + 16 * made.image.places.size();
    type.alignment = alignof(std::uint64_t);
    type.make = make_image;
    type.scan_blocks = stand_still;
    type.scan_before_all = take_in;
    type.scan_behind_all = show;
    type.valid = image_is_valid;
    type.single = true;
    type.context = &made.image;
    type.owner = owner;
    return type;
}

}  // namespace lineshaft::st
