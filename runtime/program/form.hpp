#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "runtime/model/field.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/reader.hpp"

/// What `Field` is for a block, a key is for a form of YAML: declared once, with type, limits,
/// default and doc. Tables of keys read and check files into plans (plain structs), and write the
/// JSON schema (schema.hpp) and the reference that `lineshaft form` prints.

namespace lineshaft {

struct Form;
using FormOf = const Form& (*)();  ///< forms refer to each other

/// What may stand at a key, in a list or in a map.
struct Shape {
    enum class Kind : std::uint8_t {
        scalar,   ///< a single value; its type is that of the name it is for
        name,     ///< letters, digits and '_'
        signal,   ///< block.port, inputs.name or outputs.name
        task,     ///< a task's name
        number,   ///< its unit is that of the signal or parameter it is for
        boolean,  ///< true or false
        integer,  ///< within `least` and `most`
        time,     ///< whole nanoseconds, within `least` and `most`
        share,    ///< a time, or a percentage of another one
        choice,   ///< one of `names`
        nothing,  ///< no value
        version,  ///< 1
        list,     ///< `least` to `most` of `of[0]`
        map,      ///< names or signals, each with `of[0]`
        form,     ///< a map with the keys of a form
        block,    ///< a map with the keys of its type of block
        either,   ///< one of the shapes `of`; the last of them is the one that messages are about
    };

    Kind kind = Kind::scalar;
    std::string_view what = {};  ///< subject of messages, else the key; what a choice chooses; what
                                 ///< the names of a map name, empty for signals
    std::vector<Shape> of = {};
    FormOf form = nullptr;
    std::vector<std::string_view> names = {};
    std::int64_t least = std::numeric_limits<std::int64_t>::min();
    std::int64_t most = std::numeric_limits<std::int64_t>::max();
    std::string_view limit = {};  ///< message about what is beyond; `{}` is what is written
    std::string_view help = {};   ///< below that message
    bool numbered = false;        ///< a map's names are whole numbers within `least` and `most`
    std::string_view twice = {};  ///< message about an item that stands in the list before

    Shape within(std::int64_t low, std::int64_t high, std::string_view message = {},
                 std::string_view advice = {}) const;
    Shape at_least(std::int64_t low, std::string_view message = {},
                   std::string_view advice = {}) const;
    Shape above_zero(std::string_view message) const { return at_least(1, message); }
    /// A list or a map that has something in it.
    Shape filled(std::string_view message, std::string_view advice = {}) const;
    Shape unique(std::string_view message) const;
    Shape as(std::string_view subject) const;
};

inline const Shape a_value{};
inline const Shape a_name{.kind = Shape::Kind::name};
inline const Shape a_signal{.kind = Shape::Kind::signal, .what = "a signal"};
inline const Shape a_task{.kind = Shape::Kind::task, .what = "a task's name"};
inline const Shape a_number{.kind = Shape::Kind::number, .what = "a number"};
inline const Shape a_boolean{.kind = Shape::Kind::boolean};
inline const Shape an_integer{.kind = Shape::Kind::integer};
inline const Shape a_time{.kind = Shape::Kind::time};
inline const Shape a_time_or_share{.kind = Shape::Kind::share};
inline const Shape nothing{.kind = Shape::Kind::nothing};
inline const Shape a_version{.kind = Shape::Kind::version};
Shape a_form(FormOf form);
Shape a_block(FormOf common);  ///< `common` is what all types of block have
Shape one_of(std::string_view what, std::vector<std::string_view> names);
Shape list_of(Shape item);
/// A list may be empty unless there is a message about that.
Shape one_or_list(Shape item, std::string_view empty = {});
Shape named(std::string_view what, Shape value);
Shape signals_to(Shape value);
Shape numbered(std::string_view what, std::int64_t least, std::int64_t most, Shape value);
Shape either(std::vector<Shape> shapes);

struct Key {
    std::string_view name = {};
    Shape shape = {};
    std::string_view doc = {};
    void (*store)(const Reader&, const Key&, const Node&, void* plan) = nullptr;
    std::size_t offset = 0;  ///< of the plan that `store` takes in the form's
    bool required = false;
    std::string_view help = {};       ///< below the message that it is missing
    std::string_view otherwise = {};  ///< the default as it would be written
    std::string_view word = {};       ///< what may stand here beside the shape and says the default

    Key must(std::string_view advice = {}) const;
    Key by_default(std::string_view text) const;
    Key or_word(std::string_view text) const;
};

/// What holds between the keys of one map.
struct Rule {
    enum class Kind : std::uint8_t {
        not_with,      ///< `key` stands beside none of `others`
        only_with,     ///< `key` stands beside one of `others`; what says the default is not there
        at_least_one,  ///< of `others` is there; a misspelt key may have been it
        exactly_one,   ///< of `others` is there; a misspelt key may have been it
    };
    enum class Place : std::uint8_t { the_map, the_key, the_other };  ///< what a message points at

    Kind kind = Kind::at_least_one;
    std::string_view key = {};
    std::vector<std::string_view> others = {};
    std::string_view message = {};  ///< `{0}` is the form, `{1}` the key, `{2}` the other
    std::string_view help = {};
    Place place = Place::the_map;
    const char* code = nullptr;  ///< else L0213 of what stands beside another, L0202 of what lacks
};

/// A table of keys and what a table cannot say.
struct Form {
    std::string_view name;  ///< of `lineshaft form`, and in the schema
    std::string_view what;  ///< in messages: `a task`
    std::string_view doc;
    std::vector<Key> keys = {};
    std::vector<Rule> rules = {};
    Key others = {};  ///< keys that the file chooses, for `check` to read; nameless: there are none
    Key phrase = {};  ///< a key with values in it: `within TIME of SIGNAL`; likewise
    std::string_view unknown = "{1} has no key '{0}'";  ///< message about another key
    const char* unknown_code = code::unknown_key;
    void (*check)(const Reader&, const Node&, void* plan) = nullptr;   ///< when all keys are read
    bool (*probe)(const Form&, const Reader&, const Node&) = nullptr;  ///< reads, and keeps nothing

    const Key* find(std::string_view key) const;
    /// What stands in a map at this key, or at the phrase if that is its name; or null.
    const Node* find_in(const Node& map, std::string_view key) const;
    /// It begins with the phrase's first word, and another follows.
    bool is_phrase(std::string_view key) const;
    /// The keys and rules of `part` as well, whose plan is this one's or its member. They come
    /// last, or `ahead` of this form's, but behind its version.
    Form with(const Form& part, std::size_t offset = 0, bool ahead = false) const;
    template <auto Member>
    Form with(const Form& part) const {
        return with(part, detail::offset_of(Member));
    }
    Form behind(const Form& part) const { return with(part, 0, true); }
    template <auto Member>
    Form behind(const Form& part) const {
        return with(part, detail::offset_of(Member), true);
    }
};

/// These, each followed by those that stand in it; each once.
std::vector<const Form*> forms_in(std::span<const FormOf> files);

namespace detail {

bool read_form(const Form&, const Reader&, const Node& map, void* plan, std::string_view what,
               const Node* place);

}  // namespace detail

/// Reads a map into `plan`, whose other members keep what they have. Whatever is wrong is reported
/// and leaves its member alone; false if anything was. `what` names the map in messages, else the
/// form does; a missing key is reported at `place`, else at the map.
template <class Plan>
bool read_form(const Form& form, const Reader& read, const Node& map, Plan& plan,
               std::string_view what = {}, const Node* place = nullptr) {
    return detail::read_form(form, read, map, &plan, what, place);
}

/// True if `node` is of this shape; else says what is wrong. `key` is its subject if it has none.
bool accept(const Reader& read, const Shape& shape, const Node& node, std::string_view key);

// What a key's value is stored in.
using Pairs = std::vector<std::pair<Node, Node>>;
void put(const Reader&, const Key&, const Node&, std::int64_t&);
void put(const Reader&, const Key&, const Node&, std::optional<std::int64_t>&);
void put(const Reader&, const Key&, const Node&, std::uint64_t&);
void put(const Reader&, const Key&, const Node&, bool&);  ///< of two choices the second
void put(const Reader&, const Key&, const Node&, std::string&);
void put(const Reader&, const Key&, const Node&, Node&);
void put(const Reader&, const Key&, const Node&, std::optional<Node>&);
void put(const Reader&, const Key&, const Node&, std::vector<Node>&);
void put(const Reader&, const Key&, const Node&, std::vector<std::string>&);
void put(const Reader&, const Key&, const Node&, Pairs&);

/// The scalars of a list or a map are kept where others are wrong. Of a list of forms, those that
/// are without mistakes.
template <class Plan>
void put(const Reader& read, const Key& key, const Node& node, std::vector<Plan>& plans) {
    for (const Node& item : node.items)
        if (Plan plan{}; read_form(key.shape.of[0].form(), read, item, plan))
            plans.push_back(std::move(plan));
}

template <class Plan>
requires std::is_class_v<Plan>
void put(const Reader& read, const Key& key, const Node& node, Plan& plan) {
    read_form(key.shape.form(), read, node, plan);
}

namespace detail {

template <class Plan, class T>
Plan plan_of(T Plan::*);
template <class Plan>
Plan plan_of(void (*)(const Reader&, const Node&, Plan&));

template <auto Target>
void store(const Reader& read, const Key& key, const Node& node, void* memory) {
    auto& plan = *static_cast<decltype(plan_of(Target))*>(memory);
    if constexpr (std::is_member_pointer_v<decltype(Target)>)
        put(read, key, node, plan.*Target);
    else
        Target(read, node, plan);
}

}  // namespace detail

/// `Target` is a member of the plan, or a function `(const Reader&, const Node&, Plan&)`, which
/// gets a node of the shape's outermost kind.
template <auto Target>
Key key(std::string_view name, Shape shape, std::string_view doc) {
    return {.name = name, .shape = std::move(shape), .doc = doc, .store = detail::store<Target>};
}

/// Checked only: who holds the map takes the value.
Key key(std::string_view name, Shape shape, std::string_view doc);

/// `Check` is a function `(const Reader&, const Node&, Plan&)`.
template <auto Check>
void by(const Reader& read, const Node& map, void* plan) {
    Check(read, map, *static_cast<decltype(detail::plan_of(Check))*>(plan));
}

/// `form` for plans of this type.
template <class Plan>
Form form_of(Form form) {
    form.probe = [](const Form& self, const Reader& read, const Node& map) {
        Plan plan{};
        return read_form(self, read, map, plan);
    };
    return form;
}

}  // namespace lineshaft
