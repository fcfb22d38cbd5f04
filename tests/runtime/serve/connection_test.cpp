#include "runtime/serve/connection.hpp"

#include <array>
#include <string>

#include <catch2/catch.hpp>
#include <sys/socket.h>
#include <unistd.h>

using namespace lineshaft;

TEST_CASE("a client that takes no answers is asked for nothing more, whatever it has sent") {
    std::array<int, 2> ends{};
    REQUIRE(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) == 0);
    REQUIRE(::send(ends[0], "one two three", 13, 0) == 13);
    Connection connection(ends[1]);
    REQUIRE(connection.begin());
    std::array<char, 3> got{};
    CHECK(connection.read(got.data(), got.size()) == 3);
    CHECK(connection.write("answer", 6) == 6);
    ::shutdown(ends[0], SHUT_RD);
    CHECK(connection.write("answer", 6) == -1);
    CHECK(connection.write("answer", 6) == -1);
    CHECK(connection.read(got.data(), got.size()) == -1);
    CHECK_FALSE(connection.begin());
    ::close(ends[0]);
    ::close(ends[1]);
}

TEST_CASE("a client that sends too much is still answered") {
    std::array<int, 2> ends{};
    REQUIRE(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) == 0);
    const std::string head(20'000, 'x');
    REQUIRE(::send(ends[0], head.data(), head.size(), 0) == 20'000);
    Connection connection(ends[1]);
    REQUIRE(connection.begin());
    std::array<char, 1000> got{};
    while (connection.read(got.data(), got.size()) > 0) continue;
    CHECK_FALSE(connection.begin());
    CHECK(connection.write("refused", 7) == 7);
    CHECK(::recv(ends[0], got.data(), got.size(), 0) == 7);
    ::close(ends[0]);
    ::close(ends[1]);
}
