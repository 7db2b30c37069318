(in-package :access-plans)

(def-fact-group containers ()

  ;; (container . content)
  (<- (content-of (:d-top . :spoon)))
  (<- (content-of (:d-mid . :spoon)))
  (<- (content-of (:d-low . :spoon)))

  (<- (container-of ?location ?container)
    (man-int:location-container ?location ?container)
    (cut))
  (<- (container-of ?location ?container)
    (spec:property ?location (:above ?container))))

(def-fact-group access-designators (desig:action-grounding)

  (<- (desig:action-grounding ?action-designator (access-container ?resolved-action-designator))
    (spec:property ?action-designator (:type :accessing))
    (spec:property ?action-designator (:type ?action-type))
    (rob-int:robot ?robot)
    ;; the container: the action's object, or what its location is in
    (once (or (spec:property ?action-designator (:object ?some-object))
              (and (spec:property ?action-designator (:location ?some-location))
                   (desig:current-designator ?some-location ?location)
                   (container-of ?location ?some-object))))
    (desig:current-designator ?some-object ?container)
    (spec:property ?container (:name ?name))
    (content-of (?name . ?_))
    ;; is there anything to do?
    (-> (container-open ?name)
        (equal ?open T)
        (equal ?open NIL))
    ;; arms
    (-> (desig:desig-prop ?action-designator (:arms ?arms))
        (true)
        (-> (setof ?arm (man-int:robot-free-hand ?robot ?arm) ?free-arms)
            (equal ?arms ?free-arms)
            (fail)))
    ;; where to stand
    (-> (spec:property ?action-designator (:robot-location ?some-robot-location))
        (desig:current-designator ?some-robot-location ?robot-location)
        (lisp-fun kit:counter-stand ?robot-location))
    ;; how far
    (once (or (spec:property ?action-designator (:distance ?distance))
              (equal ?distance 0.4)))
    (desig:designator :action ((:type ?action-type)
                               (:object ?container)
                               (:arms ?arms)
                               (:robot-location ?robot-location)
                               (:distance ?distance)
                               (:already-open ?open))
                      ?resolved-action-designator)))
