(defpackage search-plans
  (:nicknames #:search)
  (:use #:common-lisp #:cram-prolog)
  (:export #:search-for-object #:search-location))
