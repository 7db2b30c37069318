; The reader is at the desk with empty hands; which books are there is left open.

HoldsAt(At(Desk),0).
[book] !HoldsAt(InHand(book),0).
[book] !HoldsAt(Noted(book),0).
