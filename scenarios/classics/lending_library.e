; A lending library. A borrowed book is due some steps later, each book after its own time: a promise
; about the future, made when the book is taken.
;
; Source: books that change hands are an example of R. Kowalski and M. Sergot, "A logic-based calculus
; of events", New Generation Computing 4, 1986; the deadline and the formulation are ours.
;
; Expected: 12 traces up to timepoint 3, where events lie at 0, 1 and 2. The atlas is due after one
; step: never taken, out at 0 and back at 1, or out at 1 and back at 2. The novel is due after two:
; the same, or out at 0 and back at 2. Neither can be taken at 2, as it could not come back. The
; books do not hinder each other: 3 x 4.
;
; Language: exists over a second timepoint, a function in arithmetic, free events with
; preconditions.

range time 0 3

sort book
book Atlas, Novel

sort steps: integer
range steps 1 2

function Due(book): steps
Due(Atlas)=1.
Due(Novel)=2.

fluent OnShelf(book)

event Borrow(book)
event Bring(book)

[book,time] Terminates(Borrow(book),OnShelf(book),time).
[book,time] Initiates(Bring(book),OnShelf(book),time).
[book,time] Happens(Borrow(book),time) -> HoldsAt(OnShelf(book),time).
[book,time] Happens(Bring(book),time) -> !HoldsAt(OnShelf(book),time).

[book,time1]
  Happens(Borrow(book),time1) ->
    ({time2} time1<time2 & time2<=time1+Due(book) & Happens(Bring(book),time2)).

[book] HoldsAt(OnShelf(book),0).
