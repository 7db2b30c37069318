(in-package :deliver-plans)

(def-fact-group targets (target-free)

  ;; a container has room for more, a cell of the table holds one thing
  (<- (target-free ?location)
    (man-int:location-container ?location ?container)
    (lisp-pred identity ?container))

  (<- (target-free ?location)
    (not (man-int:location-container ?location ?_))
    (desig:desig-reference ?location ?pose)
    (not (location-occupied ?location))
    (lisp-pred identity ?pose)))

(def-fact-group deliver-designators (desig:action-grounding)

  (<- (desig:action-grounding ?action-designator (deliver ?resolved-action-designator))
    (spec:property ?action-designator (:type :delivering))
    (rob-int:robot ?robot)
    ;; object, and the hand that it is in
    (spec:property ?action-designator (:object ?some-object-designator))
    (desig:current-designator ?some-object-designator ?object-designator)
    (-> (spec:property ?action-designator (:arm ?arm))
        (true)
        (once (or (cpoe:object-in-hand ?object-designator ?arm)
                  (equal ?arm NIL))))
    ;; where to: somewhere in particular, or where such things belong
    (-> (and (spec:property ?action-designator (:target ?some-target))
             (not (equal ?some-target NIL)))
        (and (desig:current-designator ?some-target ?target)
             (equal ?targets (?target)))
        (and (spec:property ?some-object-designator (:type ?object-type))
             (lisp-fun kit:get-object-destinations ?object-type ?targets)))
    (equal ?targets (?first-target . ?_))
    ;; where to stand
    (-> (spec:property ?action-designator (:robot-location ?some-robot-location))
        (desig:current-designator ?some-robot-location ?robot-location)
        (man-int:location-stand ?first-target ?robot-location))
    ;; the way to place, if it is given
    (once (or (desig:desig-prop ?action-designator (:place-action ?place-action))
              (equal ?place-action NIL)))
    (once (or (desig:desig-prop ?action-designator (:context ?context))
              (equal ?context NIL)))
    (desig:designator :action ((:type :delivering)
                               (:object ?object-designator)
                               (:arm ?arm)
                               (:targets ?targets)
                               (:robot-location ?robot-location)
                               (:place-action ?place-action)
                               (:context ?context))
                      ?resolved-action-designator)))
