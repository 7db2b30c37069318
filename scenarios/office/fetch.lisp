;; Fetch the mug. On the way back the robot drives round the open door, and shuts it once its hand is
;; empty.

(def-cram-function fetch-mug ()
  (enter-room)
  (drive-to *desk*)
  (take-mug-from-either-side)
  (leave-room)
  (drive-to *kitchen*)
  (put-mug)
  (drive-to *corridor*)
  (shut-door))

(fetch-mug)
