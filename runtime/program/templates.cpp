#include "runtime/program/templates.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/program/program_form.hpp"
#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

using Entry = std::pair<Node, Node>;

/// One use of a template.
class Expansion {
  public:
    Expansion(const Node& name, const Node& of, const Reader& read, Substitution& outer)
        : name_(name),
          blocks_(*of.find("blocks")),
          read_(read),
          values_(),
          inner_(values_, nullptr, read, &outer) {
        const Node* declared = of.find("parameters");
        for (const auto& [key, value] : declared ? declared->entries : std::vector<Entry>()) {
            Node& kept = values_[key.text] = value;
            outer.apply(kept);
        }
    }

    void set(const Entry& entry, const std::string& of) {
        const auto it = values_.find(entry.first.text);
        if (it != values_.end()) {
            it->second = entry.second;
            return;
        }
        std::vector<std::string> known;
        for (const auto& [name, value] : values_) known.push_back(name);
        read_.fail(code::unknown_parameter, entry.first,
                   fmt::format("the template '{}' has no parameter '{}'", of, entry.first.text),
                   suggest(entry.first.text, known));
    }

    /// A parameter without a value must be set.
    bool check_set(const std::string& of) const {
        const std::size_t before = read_.diagnostics().count();
        for (const auto& [name, value] : values_)
            if (value.is_empty())
                read_.fail(code::port_is_not_set, name_,
                           fmt::format("'{}' uses the template '{}' without its parameter '{}'",
                                       name_.text, of, name),
                           fmt::format("write set: {{{}: ...}}", name));
        return read_.diagnostics().count() == before;
    }

    void append_to(std::vector<Entry>& blocks) {
        for (const auto& [key, body] : blocks_.entries) {
            Entry made{key, body};
            made.first.text = prefixed(key.text);
            for (auto& [port, value] : made.second.entries)
                if (!block_form().find(port.text)) rename(value);
            inner_.apply(made.second);
            blocks.push_back(std::move(made));
        }
    }

  private:
    std::string prefixed(std::string_view block) const {
        return fmt::format("{}_{}", name_.text, block);
    }

    /// `gate.q`, `NOT gate.q`, `previous(gate.q)` and `gate` itself.
    void rename(Node& value) const {
        if (!value.is_scalar() || value.quoted) return;
        std::size_t begin = value.text.starts_with("NOT ") ? 4 : 0;
        if (std::string_view(value.text).substr(begin).starts_with("previous(")) begin += 9;
        const std::string name =
            value.text.substr(begin, value.text.find_first_of(".)", begin) - begin);
        if (blocks_.find(name)) value.text.replace(begin, name.size(), prefixed(name));
    }

    const Node& name_;
    const Node& blocks_;
    const Reader& read_;
    ParameterValues values_;
    Substitution inner_;
};

class Templates {
  public:
    Templates(const Node* declared, Substitution& substitution, const Reader& read)
        : declared_(declared), outer_(substitution), read_(read) {}

    void expand(std::vector<Entry>& blocks) {
        std::vector<Entry> expanded;
        expanded.reserve(blocks.size());
        for (const auto& [name, body] : blocks) names_.insert(name.text);
        for (Entry& entry : blocks)
            if (entry.second.is_map() && entry.second.find("use"))
                use(entry, expanded);
            else
                expanded.push_back(std::move(entry));
        blocks = std::move(expanded);
    }

    void warn_of_unused() const {
        for (const auto& [name, body] : declared_ ? declared_->entries : std::vector<Entry>())
            if (!used_.contains(name.text))
                read_.diagnostics().warn(code::never_read, name.mark,
                                         fmt::format("nothing uses the template '{}'", name.text),
                                         "write NAME: {use: ...} in 'blocks', or remove it");
    }

  private:
    void use(Entry& entry, std::vector<Entry>& into) {
        auto& [name, body] = entry;
        UsePlan plan;
        if (!read_.identifier(name, "a block") ||
            !read_form(use_form(), read_, body, plan, fmt::format("block '{}'", name.text)))
            return;
        const Node* found = declared_ ? declared_->find(plan.use.text) : nullptr;
        used_.insert(plan.use.text);
        if (!found)
            return read_.fail(
                code::unknown_block_type, plan.use,
                fmt::format("there is no template '{}'", plan.use.text),
                suggest(plan.use.text, declared_ ? declared_->keys() : std::vector<std::string>()));
        const Node* blocks = found->is_map() ? found->find("blocks") : nullptr;
        if (!blocks || !blocks->is_map()) return;  // the template's form tells
        Expansion expansion(name, *found, read_, outer_);
        for (Entry& one : plan.set) {
            outer_.apply(one.second);
            expansion.set(one, plan.use.text);
        }
        if (!expansion.check_set(plan.use.text)) return;
        const auto first = static_cast<std::ptrdiff_t>(into.size());
        expansion.append_to(into);
        for (auto it = into.begin() + first; it != into.end(); ++it)
            if (!names_.insert(it->first.text).second)
                read_.fail(code::named_twice, name,
                           fmt::format("there are two blocks '{}'", it->first.text));
    }

    const Node* declared_;
    Substitution& outer_;
    const Reader& read_;
    std::set<std::string> used_, names_;
};

}  // namespace

void expand_templates(Node& root, Substitution& substitution, const Reader& read) {
    const Node* declared = root.find("templates");
    Templates templates(declared && declared->is_map() ? declared : nullptr, substitution, read);
    for (auto& [key, value] : root.entries)
        if (key.text == "blocks") templates.expand(value.entries);
    templates.warn_of_unused();
}

}  // namespace lineshaft
