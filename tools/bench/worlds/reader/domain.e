; The library of scenarios/classics/lending_library.e with a reader who walks between the shelves and
; the desk. What is lent out already cannot be taken.

sort book
sort place
book Atlas, Novel
place Shelves, Desk

fluent At(place)
fluent OnShelf(book)
fluent InHand(book)
fluent Noted(book)

event WalkTo(place)
event Take(book)
event Stamp(book)
event Return(book)

[time] {place} HoldsAt(At(place),time).
[place1,place2,time] HoldsAt(At(place1),time) & HoldsAt(At(place2),time) -> place1=place2.

[place,time] Initiates(WalkTo(place),At(place),time).
[place1,place2,time] place1!=place2 -> Terminates(WalkTo(place1),At(place2),time).

[book,time] Happens(Take(book),time) -> HoldsAt(OnShelf(book),time).
[book,time] HoldsAt(At(Shelves),time) -> Initiates(Take(book),InHand(book),time).
[book,time] HoldsAt(At(Shelves),time) -> Terminates(Take(book),OnShelf(book),time).

[book,time] Happens(Stamp(book),time) -> HoldsAt(InHand(book),time).
[book,time] HoldsAt(At(Desk),time) -> Initiates(Stamp(book),Noted(book),time).

[book,time] Terminates(Return(book),InHand(book),time).
[book,time]
  HoldsAt(At(Shelves),time) & HoldsAt(InHand(book),time) ->
    Initiates(Return(book),OnShelf(book),time).
[book,time] HoldsAt(InHand(book),time) -> Terminates(Return(book),Noted(book),time).
