#include <algorithm>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "runtime/program/schema.hpp"
#include "runtime/source/diagnostic.hpp"
#include "runtime/st/functions/described.hpp"
#include "runtime/st/functions/standard.hpp"
#include "tools/lineshaft/command.hpp"
#include "tools/lineshaft/forms.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t line_width = 100;

using Kind = Shape::Kind;
std::string limits_text(const Shape& s) {
    const bool low = s.least != Shape{}.least, high = s.most != Shape{}.most;
    if (s.kind == Kind::time) return low ? " above 0" : "";
    if (low && high) return fmt::format(" {} to {}", s.least, s.most);
    return low ? fmt::format(" >= {}", s.least) : "";
}

std::string type_text(const Shape& s) {
    constexpr std::string_view names[] = {"value",        "name",   "signal",
                                          "task",         "number", "true or false",
                                          "whole number", "time",   "time or %"};
    if (s.kind < Kind::choice)
        return std::string(names[static_cast<std::size_t>(s.kind)]) + limits_text(s);
    switch (s.kind) {
        case Kind::choice:
            return fmt::format("{}", fmt::join(s.names, " or "));
        case Kind::nothing:
            return "nothing";
        case Kind::version:
            return "1";
        case Kind::list:
            return "list of " + type_text(s.of[0]);
        case Kind::map:
            return fmt::format("{}: {}",
                               s.numbered       ? "NUMBER"
                               : s.what.empty() ? "SIGNAL"
                                                : "NAME",
                               type_text(s.of[0]));
        case Kind::form:
            return fmt::format("<{}>", s.form().name);
        case Kind::block:
            return "<block>";
        default:
            break;
    }
    std::string text;
    for (const Shape& one : s.of) text += (text.empty() ? "" : " or ") + type_text(one);
    return text;
}

std::string names_text(const std::vector<std::string_view>& names) {
    return fmt::format("{}", fmt::join(names, ", "));
}

/// What the rules say of `key`, and of none where it is empty.
std::vector<std::string> notes(const Form& form, std::string_view key) {
    std::vector<std::string> texts;
    for (const Rule& rule : form.rules) {
        if (rule.key != key) continue;
        const std::string others = names_text(rule.others);
        switch (rule.kind) {
            case Rule::Kind::not_with:
                texts.push_back("not with " + others);
                break;
            case Rule::Kind::only_with:
                texts.push_back("only with " + others);
                break;
            case Rule::Kind::at_least_one:
                texts.push_back("at least one of " + others);
                break;
            case Rule::Kind::exactly_one:
                texts.push_back("one of " + others);
                break;
        }
    }
    return texts;
}

/// Lines of at most `line_width`, each but the first behind `indent` blanks.
std::string wrapped(std::string_view text, std::size_t indent) {
    std::string out;
    std::size_t column = indent;
    while (!text.empty()) {
        const std::string_view word = text.substr(0, text.find(' '));
        text.remove_prefix(std::min(word.size() + 1, text.size()));
        if (column > indent && column + 1 + word.size() > line_width) {
            out += "\n" + std::string(indent, ' ');
            column = indent;
        }
        if (column > indent) out += " ";
        out += word;
        column += word.size() + (column > indent ? 1 : 0);
    }
    return out;
}

void print_key(const Form& form, const Key& key) {
    std::string type = type_text(key.shape);
    if (!key.word.empty()) type += fmt::format(" or {}", key.word);
    std::vector<std::string> said = notes(form, key.name);
    if (!key.otherwise.empty()) said.insert(said.begin(), fmt::format("default {}", key.otherwise));
    if (key.required) said.insert(said.begin(), "must be set");
    const std::string more = said.empty() ? "" : fmt::format(" ({})", fmt::join(said, "; "));
    fmt::print("  {:20} {}\n{:23}{}\n", key.name, wrapped(type, 23), "",
               wrapped(fmt::format("{}{}", key.doc, more), 23));
}

void print(const Form& form) {
    fmt::print("{}: {}\n\n", form.name, wrapped(form.doc, form.name.size() + 2));
    for (const Key& key : form.keys) print_key(form, key);
    for (const Key& key : {form.others, form.phrase})
        if (!key.name.empty()) print_key(form, key);
    for (const std::string& note : notes(form, {})) fmt::print("\n{}\n", note);
}

nlohmann::ordered_json to_json(const Form& form, const Key& key) {
    nlohmann::ordered_json out{{"name", key.name},
                               {"type", type_text(key.shape)},
                               {"doc", key.doc},
                               {"required", key.required}};
    if (!key.otherwise.empty()) out["default"] = key.otherwise;
    if (!key.word.empty()) out["word"] = key.word;
    if (const auto said = notes(form, key.name); !said.empty()) out["rules"] = said;
    return out;
}

nlohmann::ordered_json to_json(const Form& form) {
    auto keys = nlohmann::ordered_json::array();
    for (const Key& key : form.keys) keys.push_back(to_json(form, key));
    for (const Key& key : {form.others, form.phrase})
        if (!key.name.empty()) keys.push_back(to_json(form, key));
    nlohmann::ordered_json out{{"form", form.name}, {"doc", form.doc}, {"keys", keys}};
    if (const auto said = notes(form, {}); !said.empty()) out["rules"] = said;
    return out;
}

constexpr std::string_view functions = "functions";
constexpr std::string_view about_functions =
    "What Structured Text can call of IEC 61131-3, of Siemens' SCL and of CODESYS; beside them "
    "INT_TO_REAL and its like convert, and LIMIT_INT and its like are functions of one type";

void print_functions() {
    const auto print_function = [](std::string_view name, const auto& f) {
        fmt::print("  {:20} {}\n{:23}{}\n", name, wrapped(f.signature.substr(name.size()), 23), "",
                   wrapped(f.doc, 23));
    };
    fmt::print("{}: {}\n", functions, wrapped(about_functions, functions.size() + 2));
    for (const st::Subject* subject : st::function_subjects) {
        fmt::print("\n{}\n", subject->name);
        for (const st::StandardFunction& f : subject->functions) print_function(f.name, f);
    }
    for (const st::DescribedSubject& subject : st::described_functions()) {
        fmt::print("\n{}\n", subject.name);
        for (const st::DescribedFunction& f : subject.functions) print_function(f.name(), f);
    }
    fmt::print("\ntypes\n");
    for (const st::GenericType& type : st::generic_types)
        if (!type.doc.empty()) fmt::print("  {:20} {}\n", type.name, wrapped(type.doc, 23));
}

nlohmann::ordered_json to_json(const st::StandardFunction& f, std::string_view subject) {
    auto parameters = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < static_cast<std::size_t>(f.least); ++i)
        parameters.push_back(
            {{"name", f.parameters[i].name}, {"type", st::name_of(f.parameters[i].type)}});
    nlohmann::ordered_json out{{"name", f.name}, {"subject", subject}, {"parameters", parameters}};
    if (f.most > f.least) out["most"] = f.most;
    if (f.result != st::Generic::nothing) out["result"] = st::name_of(f.result);
    out["pure"] = f.is_pure;
    out["signature"] = f.signature;
    out["doc"] = f.doc;
    return out;
}

void list_functions(bool json) {
    if (!json) return print_functions();
    auto list = nlohmann::ordered_json::array();
    for (const st::Subject* subject : st::function_subjects)
        for (const st::StandardFunction& f : subject->functions)
            list.push_back(to_json(f, subject->name));
    for (const st::DescribedSubject& subject : st::described_functions())
        for (const st::DescribedFunction& f : subject.functions)
            list.push_back({{"name", f.name()},
                            {"subject", subject.name},
                            {"signature", f.signature},
                            {"doc", f.doc}});
    fmt::print("{}\n", list.dump(2));
}

void list_forms(const std::vector<const Form*>& forms, bool json) {
    auto list = nlohmann::ordered_json::array();
    for (const Form* form : forms) {
        list.push_back(to_json(*form));
        if (!json) fmt::print("{:16} {}\n", form->name, wrapped(form->doc, 17));
    }
    if (json)
        fmt::print("{}\n", list.dump(2));
    else
        fmt::print("{:16} {}\n", functions, wrapped(about_functions, 17));
}

Exit execute(const std::string& name, bool json) {
    const std::vector<const Form*> forms = forms_in(files);
    if (name.empty()) {
        list_forms(forms, json);
        return Exit::fine;
    }
    if (name == functions) {
        list_functions(json);
        return Exit::fine;
    }
    const auto form = std::ranges::find(forms, name, &Form::name);
    if (form == forms.end()) {
        std::vector<std::string> names{std::string(functions)};
        for (const Form* known : forms) names.emplace_back(known->name);
        spdlog::error("there is no form '{}'; {}", name, suggest(name, names));
        return Exit::wrong;
    }
    if (json)
        fmt::print("{}\n", to_json(**form).dump(2));
    else
        print(**form);
    return Exit::fine;
}

}  // namespace

void add_form(CLI::App& app, Exit& result) {
    struct FormCommand {
        std::string name;
        bool json = false;
    };
    auto command = std::make_shared<FormCommand>();
    CLI::App* sub = app.add_subcommand(
        "form",
        "List the forms of programs, studies and fits, or the keys of one; or the functions of "
        "Structured Text");
    sub->add_option("name", command->name, "A form, such as task, or functions");
    sub->add_flag("--json", command->json, "Print JSON for machines");
    sub->callback([command, &result] { result = execute(command->name, command->json); });
}

}  // namespace lineshaft
