#include "runtime/projects/drawings/bodies.hpp"

#include <fmt/format.h>

#include "runtime/source/codes.hpp"

namespace lineshaft::projects {

namespace {

pugi::xml_node owner_of(pugi::xml_node body) {
    pugi::xml_node pou = body;
    while (pou && std::string_view(pou.name()) != "pou") pou = pou.parent();
    return pou;
}

/// A chart that CODESYS has beside an empty text.
pugi::xml_node free_chart(pugi::xml_node body) {
    for (const pugi::xml_node data : body.child("addData").children("data"))
        if (const auto chart = data.child("CFC")) return chart;
    return {};
}

}  // namespace

BodyText body_text(BodyContext& context, pugi::xml_node body, const std::string& name) {
    BodyText made;
    for (const pugi::xml_node language : body.children()) {
        const std::string_view form = language.name();
        if (language.type() != pugi::node_element || form == "documentation") continue;
        const Mark place = context.file.mark_of_tag(language);
        const pugi::xml_node drawn = free_chart(body);
        if (drawn && (form == "addData" || context.file.plain(language).empty())) {
            made.statements.append(NetworkText(context, drawn).statements());
        } else if (form == "ST") {
            context.file.copy(made.statements, language);
            made.statements.write("\n", place);
        } else if (form == "FBD" || form == "LD") {
            made.statements.append(NetworkText(context, language).statements());
        } else if (form == "SFC") {
            BodyText chart = chart_text(context, language, owner_of(language));
            made.members.append(chart.members);
            made.statements.append(chart.statements);
        } else if (form == "IL") {
            made.statements.append(
                list_text({context.file, context.out, context.types, context.variables},
                          context.file.texts(language)));
        } else {
            context.out.add(code::not_supported, place,
                            fmt::format("the body of '{}' is drawn ({}), which is not read", name,
                                        form == "addData" ? "in no known language" : form),
                            "convert it to Structured Text, or leave it out");
        }
        break;
    }
    return made;
}

}  // namespace lineshaft::projects
