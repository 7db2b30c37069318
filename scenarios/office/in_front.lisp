;; To the door, and open it from where one stands before it.

(def-cram-function enter ()
  (open-door-from *front*)
  (drive-to *room*))

(enter)
