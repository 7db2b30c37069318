;; Fetch the mug, and shut the door on the way back, with the mug in the hand.

(def-cram-function fetch-mug ()
  (enter-room)
  (drive-to *desk*)
  (take-mug-from-either-side)
  (leave-room)
  (shut-door)
  (drive-to *corridor*)
  (drive-to *kitchen*)
  (put-mug))

(fetch-mug)
