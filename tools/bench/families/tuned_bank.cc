#include <fmt/core.h>

#include "tools/bench/families/tuned.h"

namespace parallax::tools {
namespace {

constexpr const char* kTunedBankWorld = R"(account(1..{0}).
balance(0..{1}).
amount(1..{2}).
fluent(has(A,V)) :- account(A), balance(V).
legal(pay(A,B,M)) :- account(A), account(B), A != B, amount(M).

initiates(pay(A,B,M),has(A,V-M),T) :- happens(pay(A,B,M),T), holds(has(A,V),T), V >= M.
terminates(pay(A,B,M),has(A,V),T) :- happens(pay(A,B,M),T), holds(has(A,V),T), V >= M.
initiates(pay(A,B,M),has(B,V+M),T) :- happens(pay(A,B,M),T), holds(has(B,V),T), V+M <= {1}.
terminates(pay(A,B,M),has(B,V),T) :- happens(pay(A,B,M),T), holds(has(B,V),T), V+M <= {1}.
:- happens(pay(A,B,M),T), holds(has(A,V),T), V < M.
:- happens(pay(A,B,M),T), holds(has(B,V),T), V+M > {1}.
:- account(A), not holds(has(A,{3}),0).
:- holds(has(A,V),0), V != {3}.
)";

std::string tuned_world(const BankSize& size) {
  return tuned_calculus(size.horizon) + fmt::format(kTunedBankWorld, size.accounts,
                                                    size.max_balance, size.max_amount,
                                                    size.max_balance / size.accounts);
}

}  // namespace

std::string tuned_bank_projection(const BankSize& size) {
  auto text = tuned_world(size);
  int time = 0;
  for (const auto& [from, to, amount] : told_transfers(size)) {
    text += fmt::format("happens(pay({},{},{}),{}).\n", from, to, amount, time++);
  }
  return text;
}

std::string tuned_bank_planning(const BankSize& size) {
  return tuned_world(size) + fmt::format(
                                 "{{ happens(E,T) : legal(E) }} 1 :- step(T).\n"
                                 ":- not holds(has(1,{}),horizon).\n",
                                 size.max_balance);
}

}  // namespace parallax::tools
