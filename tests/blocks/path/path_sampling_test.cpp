#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/blocks/path/random_path.hpp"
#include "tests/count_of.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// A path that is longer than its ring, and appended as pieces are left.
class Ride {
  public:
    Ride(const RandomPath& path, std::size_t pieces) : wanted_(path), ring_(pieces) { append(); }

    /// On by dt, or to the end of the path; how much [s].
    double advance(double dt) {
        double left = dt;
        while (left > 0 && !path_.finished() && !path_.lost) {
            const double elapsed = path_.advance_to(ring_, left, path_.first + 1);
            REQUIRE(std::isfinite(elapsed));
            left -= elapsed, lasts_ += elapsed;
            append();
        }
        return lasts_;
    }

    bool is_over() const { return path_.finished() || path_.lost; }
    const PathVector position() const { return path_.now(ring_).position; }
    double length() const { return path_.total; }

  private:
    void append() {
        constexpr std::size_t most_of_one = 17;
        for (; given_ < wanted_.curves.size() &&
               path_.count - path_.first + most_of_one <= ring_.size();
             ++given_)
            REQUIRE(path_.append(ring_, wanted_.curves[given_], wanted_.limits[given_],
                                 wanted_.joints[given_]) == PathFault::none);
    }

    const RandomPath& wanted_;
    std::vector<PathPiece> ring_;
    Path path_;
    std::size_t given_ = 0;
    double lasts_ = 0;
};

}  // namespace

TEST_CASE("path: how long a random path takes does not depend on when it is looked at") {
    constexpr double rounding = 1e-9;
    const std::int64_t first = count_of("LINESHAFT_SEED", 0);
    const std::int64_t count = count_of("LINESHAFT_PATHS", 10);
    for (std::int64_t seed = first; seed < first + count; ++seed) {
        Random random(static_cast<std::uint64_t>(seed));
        const RandomPath wanted = random_path(random, 60);
        const auto pieces = static_cast<std::size_t>(random.between(20, 64));
        Ride whole(wanted, pieces);
        const double lasts = whole.advance(Path::any_time);
        CAPTURE(seed, wanted.curves.size(), pieces, lasts);
        REQUIRE(whole.is_over());
        for (const double part : {0.2, 0.013, random.decades(-3, -1)}) {
            CAPTURE(part);
            Ride sampled(wanted, pieces);
            double took = 0;
            while (!sampled.is_over() && took < 2 * lasts) took = sampled.advance(part * lasts);
            CHECK(std::abs(took - lasts) <= rounding * lasts);
            CHECK(sampled.position() == whole.position());
            CHECK(sampled.length() == whole.length());
        }
    }
}
