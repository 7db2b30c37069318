;; Fetch the mug, and leave the door open on the way back.

(def-cram-function fetch-mug ()
  (drive-to *corridor*)
  (open-door-from *aside*)
  (drive-to *front*)
  (drive-to *room*)
  (drive-to *desk*)
  (take-mug)
  (park-arm)
  (drive-to *room-leaving*)
  (drive-to *front-leaving*)
  (drive-to *kitchen*)
  (put-mug))

(fetch-mug)
