(defpackage fetch-plans
  (:nicknames #:fetch)
  (:use #:common-lisp #:cram-prolog)
  (:import-from #:mobile-plans #:pick-up-with)
  (:export #:fetch #:grasp-choices))
