(defpackage kitchen-knowledge
  (:nicknames #:kit)
  (:use #:common-lisp #:cram-prolog)
  (:export
   ;; robot
   #:*robot-name* #:arms-for
   ;; places
   #:map-pose #:*counter-cells* #:*table-cells* #:*drawers*
   #:counter-stand #:table-stand #:cell-location #:drawer-location #:stand-for
   #:location-container #:pose-of
   ;; objects
   #:get-object-likely-locations #:get-object-destinations #:get-object-grasps
   #:get-object-type-effort #:plain-key))
