(in-package :fetch-plans)

(def-fact-group fetch-designators (desig:action-grounding)

  (<- (desig:action-grounding ?action-designator (fetch ?resolved-action-designator))
    (spec:property ?action-designator (:type :fetching))
    (rob-int:robot ?robot)
    ;; object
    (spec:property ?action-designator (:object ?some-object-designator))
    (desig:current-designator ?some-object-designator ?object-designator)
    (spec:property ?object-designator (:type ?object-type))
    ;; arms: those that are free, unless somebody said which
    (-> (spec:property ?action-designator (:arms ?arms))
        (true)
        (-> (spec:property ?action-designator (:arm ?arm))
            (equal ?arms (?arm))
            (setof ?free-arm (man-int:robot-free-hand ?robot ?free-arm) ?arms)))
    ;; grasps
    (once (or (spec:property ?action-designator (:grasps ?grasps))
              (and (lisp-fun kit:get-object-grasps ?object-type ?grasps)
                   (lisp-pred identity ?grasps))))
    ;; where to look
    (once (or (and (spec:property ?action-designator (:look-location ?some-look-location))
                   (desig:current-designator ?some-look-location ?look-location))
              (and (spec:property ?object-designator (:location ?some-object-location))
                   (desig:current-designator ?some-object-location ?look-location))))
    ;; where to stand
    (once (or (and (spec:property ?action-designator (:robot-location ?some-robot-location))
                   (desig:current-designator ?some-robot-location ?robot-location))
              (man-int:location-stand ?look-location ?robot-location)))
    ;; the way to grasp, if it is given
    (once (or (desig:desig-prop ?action-designator (:pick-up-action ?some-pick-up-action))
              (equal ?some-pick-up-action NIL)))
    (desig:current-designator ?some-pick-up-action ?pick-up-action)
    (desig:designator :action ((:type :fetching)
                               (:object ?object-designator)
                               (:arms ?arms)
                               (:grasps ?grasps)
                               (:robot-location ?robot-location)
                               (:look-location ?look-location)
                               (:pick-up-action ?pick-up-action))
                      ?resolved-action-designator)))
