#include "runtime/st/code/meaning.hpp"

#include <charconv>

#include "runtime/source/letters.hpp"
#include "runtime/st/types/value_text.hpp"

namespace lineshaft::st::meaning {

std::string_view text_at(const std::byte* place) {
    return {reinterpret_cast<const char*>(place + 8), static_cast<std::size_t>(word(place, 0))};
}

void copy_text(std::byte* to, const std::byte* from, std::uint64_t room) {
    const std::uint64_t length = std::min(word(from, 0), room);
    std::memmove(to + 8, from + 8, length);
    set_word(to, 0, length);
}

bool append_text(std::byte* to, const std::byte* from, std::int64_t first, std::int64_t count) {
    const auto length = static_cast<std::int64_t>(word(from, 0));
    first = std::clamp<std::int64_t>(first, 0, length);
    count = std::clamp<std::int64_t>(count, 0, length - first);
    const auto before = static_cast<std::int64_t>(word(to, 0));
    const auto taken = std::clamp<std::int64_t>(longest_result - before, 0, count);
    std::memmove(to + 8 + before, from + 8 + first, static_cast<std::size_t>(taken));
    set_word(to, 0, static_cast<std::uint64_t>(before + taken));
    return taken == count;
}

std::int64_t compare_texts(const std::byte* a, const std::byte* b) {
    const auto order = text_at(a) <=> text_at(b);
    return order < 0 ? -1 : order > 0;
}

std::optional<std::uint64_t> character_of(const std::byte* from, std::int64_t place,
                                          std::uint32_t room) {
    if (place < 1 || place > std::int64_t{room}) return {};
    const auto at = static_cast<std::uint64_t>(place - 1);
    return at < word(from, 0) ? byte(from + 8, at) : 0;
}

bool set_character(std::byte* text, std::int64_t place, std::uint64_t value) {
    const auto at = static_cast<std::uint64_t>(place) - 1;
    const bool is_there = at < word(text, 0);
    if (is_there) set_byte(text + 8, at, value);
    return is_there;
}

std::uint64_t find_text(const std::byte* in, const std::byte* what) {
    return text_at(what).empty() ? 0 : text_at(in).find(text_at(what)) + 1;
}

template <class T>
void write_number(std::byte* to, T value, bool has_sign) {
    char* first = reinterpret_cast<char*>(to + 8);
    const int sign = has_sign && value >= T{} ? 1 : 0;
    if (sign == 1) *first = '+';
    const auto [end, error] = std::to_chars(first + sign, first + longest_result, value);
    set_word(to, 0, error == std::errc() ? static_cast<std::uint64_t>(end - first) : 0);
}

template <class T>
T number_of_text(const std::byte* from) {
    std::string_view text = text_at(from);
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    const bool is_negative = text.starts_with('-');
    if (is_negative || text.starts_with('+')) text.remove_prefix(1);
    if (text.find_first_of(".0123456789") != 0) return T{};
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc()) return T{};
    return is_negative ? -value : value;
}

std::uint64_t truth_of_text(const std::byte* from) {
    const auto is_letter = [](char a, char b) { return upper(a) == b; };
    const std::string_view text = text_at(from);
    return text == "1" || std::ranges::equal(text, std::string_view("TRUE"), is_letter) ? 1 : 0;
}

static void write_text(std::byte* to, std::string_view text) {
    std::memcpy(to + 8, text.data(), text.size());
    set_word(to, 0, text.size());
}

void write_truth(std::byte* to, bool value) {
    write_text(to, value ? "TRUE" : "FALSE");
}

void write_time(std::byte* to, std::uint64_t kind, std::int64_t value) {
    fmt::memory_buffer text;
    add_time(text, static_cast<Type::Kind>(kind), value);
    write_text(to, {text.data(), text.size()});
}

std::int64_t time_of_text(std::uint64_t kind, const std::byte* from) {
    std::string_view text = text_at(from);
    text.remove_prefix(text.find('#') + 1);  // 0 without one
    return static_cast<std::int64_t>(read_time(text, static_cast<Type::Kind>(kind)).value_or(0));
}

template void write_number(std::byte*, std::int64_t, bool);
template void write_number(std::byte*, std::uint64_t, bool);
template void write_number(std::byte*, double, bool);
template void write_number(std::byte*, float, bool);
template std::uint64_t number_of_text(const std::byte*);
template double number_of_text(const std::byte*);

}  // namespace lineshaft::st::meaning
