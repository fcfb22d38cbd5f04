#include "runtime/st/code/addresses.hpp"

#include <algorithm>
#include <limits>

#include "runtime/st/code/code.hpp"
#include "runtime/st/code/meaning.hpp"

namespace lineshaft::st {

namespace {

using meaning::set_word;
using meaning::word;

constexpr std::uint64_t first_number = 0x1000'0000, step = 16;

std::byte* place_of(const NumberedAddresses& known, std::uint64_t place) {
    return known.references + 8 * reference_slots * place;
}

const Piece* piece_of(const Code& code, const std::byte* reference) {
    const std::uint32_t number = ByteOfPiece::of(word(reference, 1)).piece;
    return number == 0 || number > code.pieces.size() ? nullptr : &code.pieces[number - 1];
}

/// Numbers that a variable takes: one behind it is its own, too.
std::uint64_t room_of(const Code& code, const Piece& piece) {
    return (code.shapes[piece.shape].bits / 8 / step + 1) * step;
}

/// The Piece of a variable of a call counts, too: others may have its place in other calls.
bool is_same(const Code& code, const std::byte* a, const std::byte* b) {
    const Piece *of_a = piece_of(code, a), *of_b = piece_of(code, b);
    const bool ends = of_a && of_b && (of_a->ends || of_b->ends);
    return word(a, 0) == word(b, 0) && (!ends || of_a == of_b);
}

/// Where the variable of a reference is, or may be; empty: neither.
std::optional<std::uint64_t> find_place(const Code& code, const NumberedAddresses& known,
                                        const std::byte* reference) {
    const std::uint64_t address = word(reference, 0);
    std::uint64_t place = (address ^ address >> 29) * 0x9E37'79B9'7F4A'7C15 >> 52;
    static_assert(numbered_places == 1 << (64 - 52));
    for (std::uint32_t looked = 0; looked < numbered_places; ++looked) {
        const std::byte* here = place_of(known, place);
        if (word(here, 1) == 0 || is_same(code, here, reference)) return place;
        place = (place + 1) % numbered_places;
    }
    return {};
}

std::uint64_t count_of(const NumberedAddresses& known) {
    return std::min<std::uint64_t>(word(known.numbers, 0), most_numbered);
}

/// The place of the one that was numbered `index`-th.
std::uint64_t numbered(const NumberedAddresses& known, std::uint64_t index) {
    return word(known.numbers, 1 + numbered_places + index) % numbered_places;
}

std::uint64_t number_at(const NumberedAddresses& known, std::uint64_t place) {
    return word(known.numbers, 1 + place);
}

/// The first number of a variable that comes to be known; empty: there are no more.
std::optional<std::uint64_t> add(const Code& code, const Piece& piece,
                                 const NumberedAddresses& known, std::uint64_t place) {
    const std::uint64_t count = count_of(known);
    std::uint64_t number = first_number;
    if (count == most_numbered) return {};
    if (count > 0) {
        const std::uint64_t last = numbered(known, count - 1);
        const Piece* before = piece_of(code, place_of(known, last));
        number = number_at(known, last) + (before ? room_of(code, *before) : step);
    }
    if (number + room_of(code, piece) > std::numeric_limits<std::uint32_t>::max()) return {};
    set_word(known.numbers, 1 + place, number);
    set_word(known.numbers, 1 + numbered_places + count, place);
    set_word(known.numbers, 0, count + 1);
    return number;
}

/// What was known as the part of a block that its base is becomes the block.
bool is_more(const Code& code, const Piece& piece, const Piece* known) {
    return piece.ends || (known && derives(code, piece.shape, known->shape));
}

}  // namespace

std::optional<std::uint64_t> number_of_reference(const Code& code, const std::byte* reference,
                                                 const NumberedAddresses& known) {
    const ByteOfPiece to = ByteOfPiece::of(word(reference, 1));
    const Piece* piece = piece_of(code, reference);
    if (!piece) return static_cast<std::uint64_t>(std::int64_t{to.byte});
    const auto place = find_place(code, known, reference);
    if (!place) return {};
    std::byte* here = place_of(known, *place);
    const bool is_new = word(here, 1) == 0;
    const auto number = is_new ? add(code, *piece, known, *place) : number_at(known, *place);
    if (!number) return {};
    if (is_new || is_more(code, *piece, piece_of(code, here))) {
        set_word(here, 0, word(reference, 0));
        set_word(here, 1, ByteOfPiece{to.piece}.word());
        set_word(here, 2, word(reference, 2));
    }
    return *number + static_cast<std::uint64_t>(std::int64_t{to.byte});
}

void find_reference(const Code& code, std::uint64_t number, const NumberedAddresses& known,
                    std::byte* reference) {
    for (std::uint32_t slot = 0; slot < reference_slots; ++slot) set_word(reference, slot, 0);
    std::uint64_t begin = 0, end = count_of(known);
    while (begin < end) {
        const std::uint64_t middle = (begin + end) / 2;
        if (number_at(known, numbered(known, middle)) <= number)
            begin = middle + 1;
        else
            end = middle;
    }
    if (begin == 0) return;
    const std::uint64_t place = numbered(known, begin - 1);
    const std::byte* found = place_of(known, place);
    const Piece* piece = piece_of(code, found);
    const std::uint64_t bytes = number - number_at(known, place);
    if (!piece || bytes >= room_of(code, *piece)) return;
    set_word(reference, 0, word(found, 0));
    const std::uint32_t number_of_piece = ByteOfPiece::of(word(found, 1)).piece;
    set_word(reference, 1, ByteOfPiece{number_of_piece, static_cast<std::int32_t>(bytes)}.word());
    set_word(reference, 2, word(found, 2));
}

}  // namespace lineshaft::st
