(defpackage transport-plans
  (:nicknames #:trans)
  (:use #:common-lisp #:cram-prolog)
  (:export #:transport))
