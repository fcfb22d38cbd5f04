#include "runtime/projects/simatic_sd.hpp"

#include <utility>
#include <vector>

#include "runtime/projects/drawings/rungs.hpp"
#include "runtime/projects/organization_blocks.hpp"
#include "runtime/source/yaml.hpp"

namespace lineshaft::projects {

namespace {

using st::Word;

/// The document put together again, block by block.
class Document {
  public:
    explicit Document(std::shared_ptr<const SourceFile> file) : text_(file) {
        Diagnostics told_by_who_compiles;
        static_cast<st::Tokens&>(p_) = st::read_tokens(file, told_by_who_compiles);
    }

    std::shared_ptr<const SourceFile> read() {
        while (!p_.is(Word::end_of_file)) {
            if (p_.is(Word::network_))
                read_network();
            else if (is_end_of_block(read_token().word))
                finish_block();
        }
        finish_block();
        made_.copy_to(text_, copied_, text_.text().size());
        return made_.finish(text_.file()->path, text_.file()->part, out_);
    }

  private:
    static bool is_end_of_block(Word word) {
        using enum Word;
        return word == end_function_ || word == end_function_block_ ||
               word == end_organization_block_;
    }

    /// `count, more : Int` is noted.
    const st::Token& read_token() {
        if (p_.is_name() && p_.is_declared()) {
            listed_.emplace_back(p_.here().text);
            const bool has_type = p_.next().word == Word::colon && st::is_name(p_.next(2).word);
            for (const std::string& name : listed_)
                if (has_type) variables_.know(name, p_.next(2).text);
        } else if (!p_.is(Word::comma)) {
            listed_.clear();
        }
        return p_.take();
    }

    /// Variables stand before the first of a block, and what is said of that.
    void read_network() {
        if (++network_ == 1) made_.copy_to(text_, copied_, begin_of_network());
        const st::Token word = p_.take();
        if (!p_.says("rung") && !p_.says("label")) return;
        networks_.copy(text_, {copied_, word.place.end});
        networks_.write("\n", word.place.mark());
        networks_.append(text_of_rungs(p_, text_, out_, variables_, network_));
        copied_ = p_.here().place.begin;
    }

    std::size_t begin_of_network() const {
        std::size_t begin = p_.here().place.begin;
        for (const st::Pragma& pragma : p_.pragmas)
            if (pragma.before == p_.at) begin = std::min<std::size_t>(begin, pragma.place.begin);
        return begin;
    }

    void finish_block() {
        const Mark place = p_.last().place.mark();
        if (!variables_.declarations().empty())
            made_.write("VAR_TEMP\n" + variables_.declarations() + "END_VAR\n", place);
        made_.append(std::exchange(networks_, {}));
        variables_ = {};
        network_ = 0;
    }

    PlacedFile text_;
    Diagnostics out_;  ///< what is wrong with what is drawn
    st::Cursor p_;
    Excerpts made_, networks_;  ///< the latter: of the block at hand
    MadeVariables variables_;
    std::vector<std::string> listed_ = {};  ///< names before the ':' of a declaration
    std::size_t copied_ = 0;
    int network_ = 0;
};

}  // namespace

void read_simatic_sd(const Reading& to, const std::string& path, const Mark& where) {
    const auto source = read_source(path, to.out, where);
    if (!source) return;
    read_organization_blocks(to, source);
    const bool is_drawn = source->text.find("RUNG") != std::string::npos;
    to.project.add(is_drawn ? Document(source).read() : source);
}

}  // namespace lineshaft::projects
