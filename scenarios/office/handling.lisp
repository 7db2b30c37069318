;; What the repaired plans share. A way that turns out to be barred is taken again after the door was
;; opened; a mug that cannot be reached from before the desk is taken from the window.

(def-cram-function enter-room ()
  (drive-to *front*)
  (with-retry-counters ((opened 1))
    (with-failure-handling
        ((navigation-pose-unreachable (e)
           (do-retry opened
             (open-door-from *aside*)
             (drive-to *front*)
             (retry))))
      (drive-to *room*))))

(def-cram-function take-mug-from-either-side ()
  (let ((?behind nil))
    (with-retry-counters ((sides 1))
      (with-failure-handling
          ((manipulation-low-level-failure (e)
             (do-retry sides
               (drive-to *room*)
               (drive-to *lane*)
               (drive-to *window*)
               (setf ?behind t)
               (retry))))
        (take-mug)))
    (park-arm)
    (when ?behind
      (drive-to *lane*))))

(def-cram-function leave-room ()
  (drive-to *room-leaving*)
  (drive-to *front-leaving*)
  (drive-to *corridor*))

(def-cram-function shut-door ()
  (drive-to *aside*)
  (perform (an action (type closing) (object (an object (name office-door)))))
  (park-arm))
