(defpackage mobile-plans
  (:nicknames #:mob)
  (:use #:common-lisp #:cram-prolog)
  (:export #:go-to-target #:turn-head #:perceive #:park-arms #:raise-torso
           #:announce #:pick-up-with #:place-at))
