#include <algorithm>
#include <iostream>
#include <string>

#include "runtime/program/program.hpp"
#include "tools/lineshaft/forms.hpp"

using namespace lineshaft;

namespace {

/// The first thing that is wrong with `text` as a map of this form; empty when nothing is.
std::string mistake(const Form& form, const std::string& text) {
    Diagnostics out;
    const Reader read(out);
    const auto root = parse_yaml(std::make_shared<SourceFile>(SourceFile{"document", text}), out);
    const Key& first = form.keys.front();
    const bool file = first.shape.kind == Shape::Kind::version;
    if (root && (!file || check_kind(read, *root, first.name))) form.probe(form, read, *root);
    return out.empty() ? "" : out.list().front().code + ": " + out.list().front().message;
}

}  // namespace

/// For tests/forms.py: lines `FORM YAML` in, for each the first mistake in it out, or an empty
/// line.
int main() {
    const std::vector<const Form*> forms = forms_in(files);
    std::string line;
    while (std::getline(std::cin, line)) {
        const auto blank = std::min(line.find(' '), line.size());
        const auto form = std::ranges::find(forms, line.substr(0, blank), &Form::name);
        std::cout << (form == forms.end() ? "no such form"
                                          : mistake(**form, line.substr(blank + 1)))
                  << "\n";
    }
}
