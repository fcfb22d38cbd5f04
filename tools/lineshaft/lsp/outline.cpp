#include <algorithm>

#include <fmt/format.h>

#include "runtime/source/encoding.hpp"
#include "runtime/st/library/test_sources.hpp"
#include "runtime/st/syntax/parser.hpp"
#include "runtime/st/syntax/style.hpp"
#include "runtime/study/study_reader.hpp"
#include "tools/lineshaft/lsp/requests.hpp"
#include "tools/lineshaft/test_files.hpp"

namespace lineshaft::lsp {

namespace {

/// Kinds of symbols of the protocol.
enum Symbol {
    module_ = 2,
    namespace_ = 3,
    class_ = 5,
    method = 6,
    property = 7,
    function = 12,
    variable = 13,
    object = 19,
    struct_ = 23
};

struct Outline {
    const Session& session;
    const Text& text;
    std::shared_ptr<const SourceFile> source = {};  ///< of what is shown, where it is not the text

    /// A byte of the source in the text.
    std::size_t in_text(std::size_t offset) const {
        if (!source || source->excerpts.empty()) return offset;
        return text.bytes_of(mark_of(source, offset, offset)).first;
    }

    Json symbol(const std::string& name, Symbol kind, std::size_t begin, std::size_t end,
                std::size_t name_begin, std::size_t name_end) const {
        return {{"name", name.empty() ? "?" : name},
                {"kind", static_cast<int>(kind)},
                {"range", text.range(begin, end, session.encoding)},
                {"selectionRange", text.range(name_begin, name_end, session.encoding)},
                {"children", Json::array()}};
    }
    Json symbol(const st::Token& name, Symbol kind, std::size_t end) const {
        const std::size_t begin = in_text(name.place.begin);
        const std::size_t name_end = begin + (name.place.end - name.place.begin);
        return symbol(std::string(name.text), kind, begin, std::max(end, name_end), begin,
                      name_end);
    }
    Json of_pou(const st::Pou& pou, std::size_t end) const;
    Json of_yaml(const Node& key, const Node& value, int depth) const;
    /// What the source declares.
    void add_to(Json& symbols) const;
};

Json Outline::of_pou(const st::Pou& pou, std::size_t end) const {
    const bool is_function = pou.kind == st::PouKind::function;
    const bool is_method = pou.kind == st::PouKind::method;
    Json made = symbol(pou.name, is_function ? function : is_method ? method : class_, end);
    for (const st::DeclarationBlock& block : pou.blocks)
        for (const st::Declaration* declared : block.declarations)
            made["children"].push_back(symbol(declared->name, variable, 0));
    for (std::size_t i = 0; i < pou.methods.size(); ++i) {
        const bool is_last = i + 1 == pou.methods.size();
        made["children"].push_back(
            of_pou(*pou.methods[i], is_last ? end : in_text(pou.methods[i + 1]->place.begin)));
    }
    return made;
}

void Outline::add_to(Json& symbols) const {
    Diagnostics untold;
    st::Tree tree;
    st::parse(st::read_tokens(source, untold, st::SourceKind::tests), tree, untold);
    for (const st::TypeDeclaration& type : tree.types)
        symbols.push_back(symbol(type.name, struct_, 0));
    for (const st::DeclarationBlock& block : tree.globals)
        for (const st::Declaration* declared : block.declarations)
            symbols.push_back(symbol(declared->name, variable, 0));
    for (std::size_t i = 0; i < tree.units.size(); ++i) {
        const bool is_last = i + 1 == tree.units.size();
        symbols.push_back(of_pou(*tree.units[i], is_last
                                                     ? text.text().size()
                                                     : in_text(tree.units[i + 1]->place.begin)));
    }
}

Json Outline::of_yaml(const Node& key, const Node& value, int depth) const {
    const auto [begin, end] = text.bytes_of(key.mark);
    std::size_t last = end;
    Json children = Json::array();
    for (const auto& [inner, of] : value.entries) {
        Json child = of_yaml(inner, of, depth - 1);
        last = std::max(last, text.offset(child["range"]["end"], session.encoding));
        if (depth > 1) children.push_back(std::move(child));
    }
    Json made = symbol(key.text, value.is_map() ? object : property, begin, last, begin, end);
    made["children"] = std::move(children);
    return made;
}

std::shared_ptr<const SourceFile> source_of(const Asked& where) {
    return std::make_shared<const SourceFile>(SourceFile{where.path, where.text});
}

Json fold(const Session& session, const Text& text, std::size_t begin, std::size_t end,
          bool is_comment) {
    const Json from = text.position(begin, session.encoding),
               to = text.position(end, session.encoding);
    if (from["line"] >= to["line"]) return nullptr;
    Json made{{"startLine", from["line"]}, {"endLine", to["line"]}};
    if (is_comment) made["kind"] = "comment";
    return made;
}

bool opens(st::Word word) {
    constexpr std::string_view words =
        " IF CASE FOR WHILE REPEAT STRUCT UNION TYPE FUNCTION FUNCTION_BLOCK PROGRAM "
        "METHOD PROPERTY CLASS INTERFACE ACTION TEST SETUP TEARDOWN NAMESPACE REGION "
        "VAR VAR_INPUT VAR_OUTPUT VAR_IN_OUT VAR_TEMP VAR_GLOBAL VAR_EXTERNAL VAR_STAT "
        "DATA_BLOCK ORGANIZATION_BLOCK ";
    return words.find(fmt::format(" {} ", st::shown(word))) != words.npos;
}

/// `END_IF` ends the last IF that is open, and what is open within it.
std::string begin_of(std::string_view end_word) {
    return std::string(end_word.substr(std::string_view("END_").size()));
}

Json structured_folds(const Session& session, const Asked& where, const Text& text) {
    Diagnostics untold;
    const st::Tokens all = st::read_tokens(source_of(where), untold, st::SourceKind::tests);
    Json folds = Json::array();
    const auto add = [&](std::size_t begin, std::size_t end, bool is_comment) {
        Json made = fold(session, text, begin, end, is_comment);
        const bool is_new = !made.is_null() && std::ranges::find(folds, made) == folds.end();
        if (is_new) folds.push_back(std::move(made));  // TYPE and its STRUCT may be the same lines
    };
    std::vector<const st::Token*> open;
    for (const st::Token& token : all.tokens) {
        const std::string_view name = st::shown(token.word);
        if (token.quoted || token.local) continue;
        if (opens(token.word)) open.push_back(&token);
        if (!name.starts_with("END_")) continue;
        const std::string begin = begin_of(name);
        const auto fits = [&](const st::Token* t) {
            const std::string_view word = st::shown(t->word);
            return word == begin || (begin == "VAR" && word.starts_with("VAR"));
        };
        const auto it = std::find_if(open.rbegin(), open.rend(), fits);
        if (it == open.rend()) continue;
        add((*it)->place.begin, token.place.begin, false);
        open.erase(std::prev(it.base()), open.end());
    }
    for (const st::Pragma& comment : all.comments)
        add(comment.place.begin, comment.place.end, true);
    return folds;
}

Json yaml_folds(const Session& session, const Asked& where, const Text& text) {
    struct Line {
        std::size_t indent, begin;
    };
    std::vector<Line> open;
    Json folds = Json::array();
    std::size_t last = 0;  // of the last line with something in it
    const auto close = [&](std::size_t indent) {
        while (!open.empty() && open.back().indent >= indent) {
            if (Json made = fold(session, text, open.back().begin, last, false); !made.is_null())
                folds.push_back(std::move(made));
            open.pop_back();
        }
    };
    for (std::size_t begin = 0; begin < where.text.size();) {
        const std::size_t end = std::min(where.text.find('\n', begin), where.text.size());
        const std::size_t first = where.text.find_first_not_of(" \t\r", begin);
        if (first < end && where.text[first] != '#') {
            close(first - begin);
            open.push_back({first - begin, begin});
            last = first;
        }
        begin = end + 1;
    }
    close(0);
    return folds;
}

}  // namespace

std::optional<Asked> asked(const Session& session, const Json& params) {
    Asked found;
    found.path = path_of(params.at("textDocument").at("uri").get<std::string>());
    Diagnostics untold;
    if (const Document* document = session.documents.find(found.path))
        found.text = document->text;
    else if (const auto file = found.path.empty() ? nullptr : read_source(found.path, untold))
        found.text = file->text;
    else
        return {};
    if (params.contains("position"))
        found.offset = Text(found.text).offset(params["position"], session.encoding);
    return found;
}

Json document_symbols(Session& session, const Json& params) {
    const auto where = asked(session, params);
    if (!where) return nullptr;
    const Text text(where->text);
    Outline outline{session, text};
    Json symbols = Json::array();
    Diagnostics untold;
    if (!is_code(where->path)) {
        if (const auto root = parse_yaml(source_of(*where), untold))
            for (const auto& [key, value] : root->entries)
                symbols.push_back(outline.of_yaml(key, value, 3));
        return symbols;
    }
    if (is_structured_text(where->path)) {
        outline.source = source_of(*where);
        outline.add_to(symbols);
    } else {
        for (const auto& source : session.project.sources_of(where->path)) {
            outline.source = source;
            outline.add_to(symbols);
        }
    }
    return symbols;
}

Json folding_ranges(Session& session, const Json& params) {
    const auto where = asked(session, params);
    if (!where) return nullptr;
    const Text text(where->text);
    return is_structured_text(where->path) ? structured_folds(session, *where, text)
                                           : yaml_folds(session, *where, text);
}

Json formatting(Session& session, const Json& params) {
    const auto where = asked(session, params);
    if (!where || !is_structured_text(where->path)) return nullptr;
    Diagnostics untold;
    const auto styled = st::in_style(source_of(*where), untold);
    if (!styled || *styled == where->text) return Json::array();
    const Json whole = Text(where->text).range(0, where->text.size(), session.encoding);
    return Json::array({{{"range", whole}, {"newText", *styled}}});
}

Json code_lenses(Session& session, const Json& params) {
    const auto where = asked(session, params);
    if (!where) return nullptr;
    const Text text(where->text);
    Json lenses = Json::array();
    const auto add = [&](std::size_t at, std::string_view title, Json arguments) {
        const std::string command = "lineshaft." + std::string(title);
        lenses.push_back(
            {{"range", text.range(at, at, session.encoding)},
             {"command",
              {{"title", title}, {"command", command}, {"arguments", std::move(arguments)}}}});
    };
    const auto file = source_of(*where);
    if (!is_structured_text(where->path)) {
        if (is_program(*file) || is_study(*file)) {
            add(0, "run", {where->path});
            if (is_program(*file)) add(0, "debug", {where->path});
            add(0, "test", {where->path});
        }
        return lenses;
    }
    Diagnostics untold;
    for (const auto& tests : texts_of_tests(file)) {
        const st::Tokens all = st::read_tokens(tests, untold, st::SourceKind::tests);
        for (std::size_t i = 0; i + 1 < all.tokens.size(); ++i) {
            const st::Token &word = all.tokens[i], &name = all.tokens[i + 1];
            if (word.word != st::Word::test_ || name.word != st::Word::text) continue;
            const std::size_t at = text.bytes_of(word.place.mark()).first;
            for (const char* title : {"test", "debug"}) add(at, title, {where->path, name.text});
        }
    }
    return lenses;
}

}  // namespace lineshaft::lsp
