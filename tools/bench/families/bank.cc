#include <fmt/core.h>

#include <cstdint>
#include <vector>

#include "tools/bench/families/families.h"
#include "tools/bench/families/tuned.h"

namespace parallax::tools {
namespace {

constexpr const char* kBankWorld =
    R"(; {0} accounts of up to {1}, transfers of up to {2}, {3} steps.

range time 0 {3}
sort account
account {4}
sort balance: integer
range balance 0 {1}
sort amount: integer
range amount 1 {2}

fluent Has(account,balance)
event Transfer(account,account,amount)

; The payer's book, then the receiver's.
[account1,account2,amount,balance1,balance2,time]
HoldsAt(Has(account1,balance1),time) & account1!=account2 & balance2=balance1-amount ->
Initiates(Transfer(account1,account2,amount),Has(account1,balance2),time).
[account1,account2,amount,balance1,balance2,time]
HoldsAt(Has(account1,balance1),time) & account1!=account2 & balance2=balance1-amount ->
Terminates(Transfer(account1,account2,amount),Has(account1,balance1),time).
[account1,account2,amount,balance1,balance2,time]
HoldsAt(Has(account2,balance1),time) & account1!=account2 & balance2=balance1+amount ->
Initiates(Transfer(account1,account2,amount),Has(account2,balance2),time).
[account1,account2,amount,balance1,balance2,time]
HoldsAt(Has(account2,balance1),time) & account1!=account2 & balance2=balance1+amount ->
Terminates(Transfer(account1,account2,amount),Has(account2,balance1),time).

; Nobody pays himself, or more than he has, or more than the other's book can hold.
[account1,account2,amount,time]
Happens(Transfer(account1,account2,amount),time) -> account1!=account2.
[account1,account2,amount,balance,time]
Happens(Transfer(account1,account2,amount),time) & HoldsAt(Has(account1,balance),time) ->
amount<=balance.
[account1,account2,amount,balance,time]
Happens(Transfer(account1,account2,amount),time) & HoldsAt(Has(account2,balance),time) ->
balance+amount<={1}.

)";

/// The world and the opening balances.
std::string opened_bank(const BankSize& size) {
  std::string text = fmt::format(kBankWorld, size.accounts, size.max_balance, size.max_amount,
                                 size.horizon, numbered_names("Acc", size.accounts));
  const int share = size.max_balance / size.accounts;
  for (int account = 1; account <= size.accounts; ++account) {
    text +=
        fmt::format("[balance] HoldsAt(Has(Acc{},balance),0) <-> balance={}.\n", account, share);
  }
  return text;
}

/// Small and the same everywhere (Park and Miller 1988).
class Draw {
 public:
  /// 0 to `count` - 1.
  int below(int count) {
    state_ = state_ * 48271 % 2147483647;
    return static_cast<int>(state_ % static_cast<std::uint64_t>(count));
  }

 private:
  std::uint64_t state_ = 1;
};

}  // namespace

std::vector<Transfer> told_transfers(const BankSize& size) {
  std::vector<Transfer> told;
  std::vector<int> balances(static_cast<std::size_t>(size.accounts),
                            size.max_balance / size.accounts);
  Draw draw;
  while (static_cast<int>(told.size()) < size.horizon) {
    const auto from = static_cast<std::size_t>(draw.below(size.accounts));
    const auto to = static_cast<std::size_t>(draw.below(size.accounts));
    const int amount = 1 + draw.below(size.max_amount);
    if (from == to || balances[from] < amount || balances[to] + amount > size.max_balance) continue;
    balances[from] -= amount;
    balances[to] += amount;
    told.push_back({static_cast<int>(from) + 1, static_cast<int>(to) + 1, amount});
  }
  return told;
}

std::string bank_projection_model(const BankSize& size) {
  std::string text = opened_bank(size) + "\ncompletion Book Happens\n";
  int time = 0;
  for (const auto& [from, to, amount] : told_transfers(size)) {
    text += fmt::format("Book: Happens(Transfer(Acc{},Acc{},{}),{}).\n", from, to, amount, time++);
  }
  return text;
}

std::string bank_planning_model(const BankSize& size) {
  return opened_bank(size) +
         fmt::format(
             "\n[event1,event2,time] Happens(event1,time) & Happens(event2,time) -> "
             "event1=event2.\nHoldsAt(Has(Acc1,{}),{}).\n",
             size.max_balance, size.horizon);
}

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
