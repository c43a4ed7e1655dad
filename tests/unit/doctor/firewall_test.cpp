#include "doctor/firewall.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace scree {
namespace {

using ::testing::HasSubstr;
using Verdict = Finding::Verdict;

/// A ruleset as `nft list ruleset` prints it.
std::string ruleset(const std::string& policy, const std::string& rule) {
  return "table inet filter {\n\tchain input {\n"
         "\t\ttype filter hook input priority filter; policy " +
         policy + ";\n\t\tct state established,related accept\n\t\t" + rule +
         "\n\t}\n\n\tchain forward {\n\t\ttype filter hook forward priority filter; policy drop;\n"
         "\t}\n}\n";
}

Verdict verdict_of(const std::string& nft, const std::string& iptables = "") {
  return check_firewall(nft, iptables, 2368).verdict;
}

TEST(Firewall, WithoutRulesAllComesIn) {
  EXPECT_EQ(verdict_of(""), Verdict::ok);
  EXPECT_EQ(verdict_of(ruleset("accept", "")), Verdict::ok);
  EXPECT_EQ(verdict_of("", "-P INPUT ACCEPT\n"), Verdict::ok);
}

TEST(Firewall, AChainThatDropsMustNameThePort) {
  EXPECT_EQ(verdict_of(ruleset("drop", "tcp dport 22 accept")), Verdict::wrong);
  EXPECT_EQ(verdict_of(ruleset("drop", "udp dport 23680 accept")), Verdict::wrong);
  EXPECT_EQ(verdict_of(ruleset("drop", "udp dport { 2368, 8308 } accept")), Verdict::ok);
  EXPECT_EQ(verdict_of("", "-P INPUT DROP\n-A INPUT -p tcp --dport 22 -j ACCEPT\n"),
            Verdict::wrong);
  EXPECT_EQ(verdict_of("", "-P INPUT DROP\n-A INPUT -p udp --dport 2368 -j ACCEPT\n"), Verdict::ok);
}

TEST(Firewall, ARuleMayDropThePort) {
  EXPECT_EQ(verdict_of(ruleset("accept", "udp dport 2368 drop")), Verdict::wrong);
  EXPECT_EQ(verdict_of("", "-P INPUT ACCEPT\n-A INPUT -p udp --dport 2368 -j DROP\n"),
            Verdict::wrong);
  EXPECT_THAT(check_firewall(ruleset("accept", "udp dport 2368 reject"), "", 2368).text,
              HasSubstr("UDP port 2368"));
}

}  // namespace
}  // namespace scree
