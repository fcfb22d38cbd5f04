#include <fmt/format.h>

#include "runtime/st/syntax/grammar.hpp"

namespace lineshaft::st {

namespace {

/// Where a CONFIGURATION is being read.
struct ConfigurationAt {
    std::string_view name, resource;
};

/// Up to the end of one that is given, which other words may stand in, too.
void skip_connection(Parsing& p) {
    int open = 0;
    for (; !p.is(Word::end_of_file) && !p.is(Word::semicolon); p.take()) {
        if (open == 0 && (p.is(Word::comma) || p.is(Word::close))) return;
        open += p.is(Word::open) ? 1 : p.is(Word::close) ? -1 : 0;
    }
}

/// Prog_Conf_Elem : Variable_Access ( ( ':=' | '=>' ) Expression | 'WITH' Name )
void parse_connection(Parsing& p, ProgramInstance& to) {
    Connection made{.own = parse_access(p)};
    made.is_output = p.is(Word::output);
    const bool is_connected = !p.panic && (p.accept(Word::output) || p.accept(Word::assign));
    if (is_connected) made.other = parse_expression(p);
    if (!is_connected || p.panic) {
        p.panic = false;
        return skip_connection(p);
    }
    to.connections.push_back(made);
}

/// Prog_Config : 'PROGRAM' ( 'RETAIN' | 'NON_RETAIN' ) ? Name ( 'WITH' Name ) ? ':' Qualified_Name
///               ( '(' ( Prog_Conf_Elem ( ',' Prog_Conf_Elem ) * ) ? ')' ) ? ';'
void parse_program_configuration(Parsing& p, const ConfigurationAt& at) {
    const auto path_of = [&](std::string_view before, std::string_view name) {
        return before.empty() ? name
                              : std::string_view(
                                    p.tree.names.emplace_back(fmt::format("{}.{}", before, name)));
    };
    p.take();
    p.accept(Word::retain_) || p.accept(Word::non_retain_);
    ProgramInstance made{.name = expect_name(p, "the name of the program")};
    made.path = path_of(at.resource.empty() ? at.name : at.resource, made.name.text);
    made.whole_path = at.resource.empty() ? made.path : path_of(at.name, made.path);
    if (p.says("with")) p.take(), expect_name(p, "the name of a task");
    if (!p.panic && expect(p, Word::colon, "after the name"))
        made.type = parse_qualified_name(p, "the name of a PROGRAM");
    if (!p.panic && p.accept(Word::open)) {
        do
            if (!p.is(Word::close)) parse_connection(p, made);
        while (p.accept(Word::comma));
        expect(p, Word::close, "behind what the program is given");
    }
    if (!p.panic) end_statement(p);
    if (p.panic) return skip_declaration(p);
    p.tree.instances.push_back(std::move(made));
}

/// Config_Inst_Init : Qualified_Name ( 'AT' Direct ( ':' Data_Type ) ? | ':' Data_Type )
///                    ( ':=' Var_Init ) ? ';'
/// It may be an element, too. With an address logi.CAD leaves the type out.
void parse_configured_variable(Parsing& p, std::string_view resource) {
    ConfiguredVariable made{.path = parse_access(p), .resource = resource};
    if (!p.panic && p.accept(Word::at_)) {
        made.at = p.here();
        expect(p, Word::direct, "behind AT");
    }
    const bool is_typed = made.at.word == Word::end_of_file || p.is(Word::colon);
    if (!p.panic && is_typed && expect(p, Word::colon, "after the variable"))
        made.type = parse_type(p);
    if (!p.panic && p.accept(Word::assign)) made.initial = parse_initials(p);
    if (!p.panic) end_statement(p);
    if (p.panic) return skip_declaration(p);
    p.tree.configured.push_back(made);
}

}  // namespace

bool at_var_config(const Parsing& p) {
    return p.is(Word::name) && p.here().first_in_line && p.says("var_config");
}

/// Var_Config : 'VAR_CONFIG' Config_Inst_Init * 'END_VAR' ';' ?
void parse_var_config(Parsing& p, std::string_view resource) {
    const Token opener = p.take();
    while (p.is_name()) parse_configured_variable(p, resource);
    close(p, Word::end_var_, opener);
    p.accept(Word::semicolon);
}

/// Config_Decl : 'CONFIGURATION' Name ( Var_Section | Var_Config | Prog_Config | Any_Token ) *
///               'END_CONFIGURATION' ';' ?
/// Its variables are VAR_GLOBAL; its tasks are left to who makes a program of it.
void parse_configuration(Parsing& p) {
    const Token opener = p.take();
    ConfigurationAt at;
    if (p.is_name()) at.name = p.take().text;
    while (!p.is(Word::end_of_file) && !p.says("end_configuration")) {
        if (p.is(Word::var_global_)) {
            p.tree.globals.push_back(parse_section(p, Section::global));
        } else if (at_var_config(p)) {
            parse_var_config(p, at.resource);
        } else if (p.is(Word::program_)) {
            parse_program_configuration(p, at);
        } else {
            if (p.says("resource") && p.is_name(1)) at.resource = p.next().text;
            if (p.says("end_resource")) at.resource = {};
            p.take();
        }
    }
    if (p.is(Word::end_of_file))
        tell(p, code::something_else_expected, opener.place, "the CONFIGURATION does not end",
             "it ends with END_CONFIGURATION");
    p.take();
    p.accept(Word::semicolon);
}

}  // namespace lineshaft::st
