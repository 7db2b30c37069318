;; Buy a ticket, twice if the machine gave none, and take the red bus; without a ticket stay.

(def-cram-function travel ()
  (with-failure-handling
      ((manipulation-low-level-failure (e)
         (perform (an action (type buying)))
         (return)))
    (perform (an action (type buying))))
  (perform (an action (type boarding) (bus :red)))
  (perform (an action (type riding) (bus :red))))

(travel)
