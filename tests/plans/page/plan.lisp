; A plan for the binding table of docs/reference/plan_language.md: the robot opens one drawer after the
; other until it sees a spoon. The first `return` gives the value of `with-failure-handling`, the second
; leaves the loop.
(def-cram-function fetch (?object ?arm)
  (perform (an action (type picking-up) (arm ?arm) (object ?object))))
(def-top-level-cram-function tidy-up ()
  (dolist (?drawer '(:d-mid :d-low))
    (perform (an action (type opening) (object (an object (name ?drawer)))))
    (when (with-failure-handling ((perception-object-not-found (e) (return nil)))
            (perform (an action (type detecting) (object (an object (type spoon))))))
      (return)))
  (perform (an action (type fetching) (object (an object (type spoon))) (arm left)))
  (when (prolog '(object-in-hand spoon1))
    (perform (an action (type placing) (arm left) (object (an object (name spoon1)))
                (target (a location (in (an object (name d-mid)))))))))
