(defpackage access-plans
  (:nicknames #:access)
  (:use #:common-lisp #:cram-prolog)
  (:export #:access-container #:container-above))
