(defpackage store-plans
  (:nicknames #:store)
  (:use #:common-lisp #:cram-prolog)
  (:shadow #:store)
  (:export #:store #:choose-container))
