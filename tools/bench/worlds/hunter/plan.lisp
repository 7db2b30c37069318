;; Load, spin, aim, shoot; who has missed does so again without spinning.

(def-cram-function hunt ()
  (perform (an action (type loading)))
  (perform (an action (type spinning)))
  (with-failure-handling
      ((manipulation-low-level-failure (e)
         (perform (an action (type loading)))
         (perform (an action (type aiming)))
         (perform (an action (type shooting)))
         (return)))
    (perform (an action (type aiming)))
    (perform (an action (type shooting)))))

(hunt)
