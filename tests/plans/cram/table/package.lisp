(defpackage table-plans
  (:nicknames #:table)
  (:use #:common-lisp #:cram-prolog)
  (:export #:set-table #:bring-one))
