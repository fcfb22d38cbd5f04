#include "runtime/program/form.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

using Kind = Shape::Kind;

Shape beyond(Shape shape, std::string_view message, std::string_view advice) {
    shape.limit = message;
    shape.help = advice;
    return shape;
}

std::string quoted(std::string_view key) {
    return fmt::format("'{}'", key);
}

bool says_default(const Key& key, const Node& node) {
    return node.is_scalar() && !node.text.empty() &&
           (node.text == key.word || node.text == key.otherwise);
}

/// Whether a list or a map is as long as it may be. A limit without a message is for who reads it.
bool check_size(const Reader& read, const Shape& s, const Node& node, std::size_t size) {
    const auto count = static_cast<std::int64_t>(size);
    if (s.limit.empty() || (count >= s.least && count <= s.most)) return true;
    read.fail(s.least == 1 ? code::entry_is_missing : code::row_of_wrong_length, node,
              std::string(s.limit), std::string(s.help));
    return false;
}

/// About a map of names that was written as something else.
std::string key_help(const Shape& s) {
    if (s.what.empty()) return {};
    const Shape& item = s.of[0].of.empty() ? s.of[0] : s.of[0].of.back();
    return fmt::format("write the {}'s name as a key: NAME: {}",
                       s.what.substr(s.what.find(' ') + 1), item.form ? "{...}" : "VALUE");
}

bool accept_list(const Reader& read, const Shape& s, const Node& node, std::string_view key) {
    if (!read.expect_sequence(node, key)) return false;
    bool good = check_size(read, s, node, node.items.size());
    for (auto item = node.items.begin(); item != node.items.end(); ++item) {
        good = accept(read, s.of[0], *item, key) && good;
        const auto same = [&](const Node& other) { return other.text == item->text; };
        if (s.twice.empty() || !item->is_scalar() || std::none_of(node.items.begin(), item, same))
            continue;
        read.fail(code::named_twice, *item, fmt::format(fmt::runtime(s.twice), item->text));
        good = false;
    }
    return good;
}

std::optional<std::int64_t> whole(const Reader& read, const Shape& s, const Node& node) {
    const bool time = s.kind == Kind::time;
    const auto number = time ? read.time(node) : read.integer(node, std::string(s.help));
    if (!number || (*number >= s.least && *number <= s.most)) return number;
    const bool below = *number < s.least;
    read.fail(time ? code::not_a_time : code::number_out_of_range, node,
              s.limit.empty() ? fmt::format("'{}' is {} {}", node.text, below ? "below" : "above",
                                            below ? s.least : s.most)
                              : fmt::format(fmt::runtime(s.limit), node.text),
              std::string(s.help));
    return {};
}

bool accept_map(const Reader& read, const Shape& s, const Node& node, std::string_view key) {
    if (!read.expect_map(node, key, key_help(s))) return false;
    bool good = check_size(read, s, node, node.entries.size());
    const auto is_name = [&](const Node& name) {
        if (s.numbered) return whole(read, an_integer.within(s.least, s.most), name).has_value();
        return s.what.empty() || read.identifier(name, s.what);
    };
    for (const auto& [name, value] : node.entries)
        good = is_name(name) && accept(read, s.of[0], value, s.what.empty() ? key : s.what) && good;
    return good;
}

/// A block of a template, whose parameters have no values yet.
bool accept_block(const Reader& read, const Form& common, const Node& node) {
    if (!read.expect_map(node, common.what)) return false;
    bool good = true;
    for (const Key& key : common.keys) {
        if (!key.required || node.find(key.name)) continue;
        read.fail(code::entry_is_missing, node,
                  fmt::format("{} has no '{}'", common.what, key.name), std::string(key.help));
        good = false;
    }
    return good;
}

/// The one of `shapes` that is meant.
const Shape& meant(const std::vector<Shape>& shapes, const Node& node) {
    const auto fits = [&](const Shape& s) {
        if (s.kind == Kind::list) return node.is_sequence();
        if (s.kind == Kind::map || s.kind == Kind::form) return node.is_map();
        return node.is_scalar() && (s.kind != Kind::nothing || node.is_empty());
    };
    const auto it = std::ranges::find_if(shapes, fits);
    return it == shapes.end() ? shapes.back() : *it;
}

std::optional<std::size_t> chosen(const Reader& read, const Shape& s, const Node& node,
                                  std::string_view key) {
    if (!read.expect_scalar(node, key)) return {};
    const auto it = std::ranges::find(s.names, node.text);
    if (it != s.names.end()) return static_cast<std::size_t>(it - s.names.begin());
    read.fail(code::no_allowed_name, node, fmt::format("'{}' is not {}", node.text, s.what),
              fmt::format("known: {}", fmt::join(s.names, ", ")));
    return {};
}

const Node* present(const Form& form, const Node& map, std::string_view name) {
    const Node* node = form.find_in(map, name);
    return node && form.find(name) && says_default(*form.find(name), *node) ? nullptr : node;
}

void apply(const Form& form, const Rule& rule, const Reader& read, const Node& map) {
    const Node* node = rule.key.empty() ? nullptr : form.find_in(map, rule.key);
    const auto fail = [&](std::string_view other, std::string_view usual, const Node* place) {
        const std::string_view message = rule.message.empty() ? usual : rule.message;
        const Node* at = rule.place == Rule::Place::the_map ? &map : place;
        const bool both = rule.kind == Rule::Kind::not_with;
        read.fail(rule.code ? rule.code
                  : both    ? code::entries_do_not_go_together
                            : code::entry_is_missing,
                  *at, fmt::format(fmt::runtime(message), form.what, rule.key, other),
                  std::string(rule.help));
    };
    if (rule.kind == Rule::Kind::not_with) {
        for (const std::string_view other : rule.others)
            if (const Node* n = form.find_in(map, other); node && n)
                fail(other, "{0} says '{1}' or '{2}', not both",
                     rule.place == Rule::Place::the_key ? node : n);
        return;
    }
    if (rule.kind == Rule::Kind::exactly_one) {
        const auto counts = [&](const auto& entry) {
            return !form.find(entry.first.text) ||
                   std::ranges::find(rule.others, entry.first.text) != rule.others.end();
        };
        if (std::ranges::count_if(map.entries, counts) != 1) fail({}, {}, nullptr);
        return;
    }
    const bool conditional = rule.kind == Rule::Kind::only_with;
    if (conditional && !present(form, map, rule.key)) return;
    const auto there = [&](std::string_view other) {
        return conditional ? present(form, map, other) : form.find_in(map, other);
    };
    const auto is_unknown = [&](const auto& entry) { return !form.find(entry.first.text); };
    const bool misspelt =
        !conditional && form.others.name.empty() && std::ranges::any_of(map.entries, is_unknown);
    if (!misspelt && std::ranges::none_of(rule.others, there))
        fail(rule.others.front(), "{0} has no '{2}'", node);
}

void refuse_unknown(const Form& form, const Reader& read, const Node& map, std::string_view what) {
    for (const auto& [name, value] : map.entries) {
        if (form.find(name.text)) continue;
        std::vector<std::string> known;
        for (const Key& k : form.keys) known.emplace_back(k.name);
        read.fail(form.unknown_code, name, fmt::format(fmt::runtime(form.unknown), name.text, what),
                  name.text.find(':') == std::string::npos ? suggest(name.text, known)
                                                           : "a blank is missing after ':'");
    }
}

/// What a reader of its own may rely on.
bool open(const Reader& read, const Key& key, const Node& node) {
    const Shape& s = key.shape;
    if (s.kind == Kind::list)
        return read.expect_sequence(node, quoted(key.name)) &&
               check_size(read, s, node, node.items.size());
    if (s.kind == Kind::map)
        return read.expect_map(node, quoted(key.name), key_help(s)) &&
               check_size(read, s, node, node.entries.size());
    return true;
}

void collect(const Form& form, std::vector<const Form*>& into);

void collect(const Shape& shape, std::vector<const Form*>& into) {
    if (shape.form) collect(shape.form(), into);
    for (const Shape& part : shape.of) collect(part, into);
}

void collect(const Form& form, std::vector<const Form*>& into) {
    if (std::ranges::find(into, &form) != into.end()) return;
    into.push_back(&form);
    for (const Key& key : form.keys) collect(key.shape, into);
    collect(form.others.shape, into);
    collect(form.phrase.shape, into);
}

}  // namespace

Shape Shape::within(std::int64_t low, std::int64_t high, std::string_view message,
                    std::string_view advice) const {
    Shape s = beyond(*this, message, advice);
    s.least = low;
    s.most = high;
    return s;
}
Shape Shape::at_least(std::int64_t low, std::string_view message, std::string_view advice) const {
    return within(low, most, message, advice);
}
Shape Shape::filled(std::string_view message, std::string_view advice) const {
    return at_least(1, message, advice);
}
Shape Shape::unique(std::string_view message) const {
    Shape s = *this;
    s.twice = message;
    return s;
}

Shape Shape::as(std::string_view subject) const {
    Shape s = *this;
    s.what = subject;
    return s;
}

Shape a_block(FormOf common) {
    return {.kind = Kind::block, .form = common};
}
Shape a_form(FormOf form) {
    return {.kind = Kind::form, .form = form};
}
Shape one_of(std::string_view what, std::vector<std::string_view> names) {
    return {.kind = Kind::choice, .what = what, .names = std::move(names)};
}
Shape list_of(Shape item) {
    return {.kind = Kind::list, .of = {std::move(item)}};
}
Shape one_or_list(Shape item, std::string_view empty) {
    const Shape list = list_of(item);
    return either({empty.empty() ? list : list.filled(empty), item});
}
Shape named(std::string_view what, Shape value) {
    return {.kind = Kind::map, .what = what, .of = {std::move(value)}};
}
Shape signals_to(Shape value) {
    return {.kind = Kind::map, .of = {std::move(value)}};
}
Shape numbered(std::string_view what, std::int64_t least, std::int64_t most, Shape value) {
    Shape s = named(what, std::move(value)).within(least, most);
    s.numbered = true;
    return s;
}
Shape either(std::vector<Shape> shapes) {
    return {.kind = Kind::either, .of = std::move(shapes)};
}

Key Key::must(std::string_view advice) const {
    Key k = *this;
    k.required = true;
    k.help = advice;
    return k;
}
Key Key::by_default(std::string_view text) const {
    Key k = *this;
    k.otherwise = text;
    return k;
}
Key Key::or_word(std::string_view text) const {
    Key k = *this;
    k.word = text;
    return k;
}
Key key(std::string_view name, Shape shape, std::string_view doc) {
    return {.name = name, .shape = std::move(shape), .doc = doc};
}

const Key* Form::find(std::string_view name_of_key) const {
    const auto it = std::ranges::find(keys, name_of_key, &Key::name);
    return it == keys.end() ? nullptr : &*it;
}

bool Form::is_phrase(std::string_view key) const {
    return !phrase.name.empty() &&
           key.starts_with(phrase.name.substr(0, phrase.name.find(' ') + 1));
}

const Node* Form::find_in(const Node& map, std::string_view key) const {
    if (key != phrase.name) return map.find(key);
    const auto it = std::ranges::find_if(
        map.entries, [this](const auto& entry) { return is_phrase(entry.first.text); });
    return it == map.entries.end() ? nullptr : &it->second;
}

Form Form::with(const Form& part, std::size_t offset, bool ahead) const {
    Form whole = *this;
    std::vector<Key> added = part.keys;
    for (Key& k : added) k.offset += offset;
    const bool versioned = !keys.empty() && keys.front().shape.kind == Kind::version;
    const auto place = ahead ? whole.keys.begin() + (versioned ? 1 : 0) : whole.keys.end();
    whole.keys.insert(place, added.begin(), added.end());
    whole.rules.insert(whole.rules.end(), part.rules.begin(), part.rules.end());
    return whole;
}

std::vector<const Form*> forms_in(std::span<const FormOf> files) {
    std::vector<const Form*> forms;
    for (const FormOf file : files) collect(file(), forms);
    return forms;
}

bool accept(const Reader& read, const Shape& s, const Node& node, std::string_view key) {
    switch (s.kind) {
        case Kind::name:
            return read.identifier(node, s.what);
        case Kind::number:
        case Kind::scalar:
        case Kind::signal:
        case Kind::task:
            return read.expect_scalar(node, s.what.empty() ? key : s.what);
        case Kind::boolean:
            return read.boolean(node).has_value();
        case Kind::integer:
        case Kind::time:
            return whole(read, s, node).has_value();
        case Kind::share:
            return read.time_or_share(node, 0).has_value();
        case Kind::choice:
            return chosen(read, s, node, key).has_value();
        case Kind::list:
            return accept_list(read, s, node, key);
        case Kind::map:
            return accept_map(read, s, node, key);
        case Kind::form:
            return s.form().probe(s.form(), read, node);
        case Kind::either:
            return accept(read, meant(s.of, node), node, key);
        case Kind::block:
            return accept_block(read, s.form(), node);
        case Kind::nothing:
        case Kind::version:
            return true;
    }
    return false;
}

bool detail::read_form(const Form& form, const Reader& read, const Node& map, void* plan,
                       std::string_view what, const Node* place) {
    const std::size_t before = read.diagnostics().count();
    if (what.empty()) what = form.what;
    if (!read.expect_map(map, what)) return false;
    if (form.others.name.empty()) refuse_unknown(form, read, map, what);
    for (const Key& key : form.keys) {
        const Node* node = map.find(key.name);
        if (!node && key.required)
            read.fail(code::entry_is_missing, place ? *place : map,
                      fmt::format("{} has no '{}'", what, key.name), std::string(key.help));
        if (!node || (!key.word.empty() && node->text == key.word)) continue;
        if (!key.store)
            accept(read, key.shape, *node, quoted(key.name));
        else if (open(read, key, *node))
            key.store(read, key, *node, static_cast<std::byte*>(plan) + key.offset);
    }
    for (const Rule& rule : form.rules) apply(form, rule, read, map);
    if (form.check) form.check(read, map, plan);
    return read.diagnostics().count() == before;
}

void put(const Reader& read, const Key& key, const Node& node, std::int64_t& value) {
    value = whole(read, key.shape, node).value_or(value);
}
void put(const Reader& read, const Key& key, const Node& node, std::optional<std::int64_t>& value) {
    if (const auto number = whole(read, key.shape, node)) value = number;
}
void put(const Reader& read, const Key& key, const Node& node, std::uint64_t& value) {
    if (const auto number = whole(read, key.shape, node))
        value = static_cast<std::uint64_t>(*number);
}
void put(const Reader& read, const Key& key, const Node& node, bool& value) {
    if (key.shape.kind == Kind::boolean)
        value = read.boolean(node).value_or(value);
    else if (const auto choice = chosen(read, key.shape, node, quoted(key.name)))
        value = *choice == 1;
}
void put(const Reader& read, const Key& key, const Node& node, std::string& value) {
    if (accept(read, key.shape, node, quoted(key.name))) value = node.text;
}
void put(const Reader& read, const Key& key, const Node& node, Node& value) {
    if (accept(read, key.shape, node, quoted(key.name))) value = node;
}
void put(const Reader& read, const Key& key, const Node& node, std::optional<Node>& value) {
    if (accept(read, key.shape, node, quoted(key.name))) value = node;
}
void put(const Reader& read, const Key& key, const Node& node, std::vector<Node>& values) {
    values.clear();
    accept(read, key.shape, node, quoted(key.name));
    const std::vector<Node> single{node};
    std::ranges::copy_if(node.is_sequence() ? node.items : single, std::back_inserter(values),
                         &Node::is_scalar);
}
void put(const Reader& read, const Key& key, const Node& node, std::vector<std::string>& values) {
    if (!accept(read, key.shape, node, quoted(key.name))) return;
    if (node.is_scalar()) values.push_back(node.text);
    for (const Node& item : node.items) values.push_back(item.text);
}
void put(const Reader& read, const Key& key, const Node& node, Pairs& values) {
    accept(read, key.shape, node, quoted(key.name));
    const auto usable = [&](const auto& entry) {
        return entry.second.is_scalar() &&
               (key.shape.what.empty() || is_identifier(entry.first.text));
    };
    std::ranges::copy_if(node.entries, std::back_inserter(values), usable);
}

}  // namespace lineshaft
