(defpackage seal-plans
  (:nicknames #:seal)
  (:use #:common-lisp #:cram-prolog)
  (:export #:seal-container #:with-open-container))
