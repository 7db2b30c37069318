(defpackage relay-plans
  (:nicknames #:relay)
  (:use #:common-lisp #:cram-prolog)
  (:export #:carry-both))
