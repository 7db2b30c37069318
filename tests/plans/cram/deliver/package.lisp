(defpackage deliver-plans
  (:nicknames #:deliver)
  (:use #:common-lisp #:cram-prolog)
  (:import-from #:mobile-plans #:place-at)
  (:export #:deliver))
