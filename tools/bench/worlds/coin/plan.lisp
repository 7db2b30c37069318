;; Toss, catch, see to it that the head is up, and show it; once more from there.

(def-cram-function play ()
  (perform (an action (type tossing)))
  (perform (an action (type catching)))
  (unless (holds '(heads))
    (perform (an action (type turning-over))))
  (perform (an action (type showing)))
  (perform (an action (type tossing))))

(play)
