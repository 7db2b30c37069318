(defpackage pour-plans
  (:nicknames #:pour)
  (:use #:common-lisp #:cram-prolog)
  (:export #:pour #:pouring-poses))
