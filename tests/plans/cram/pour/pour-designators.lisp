(in-package :pour-plans)

(def-fact-group pouring-knowledge (pourable)

  ;; (from . into)
  (<- (pourable (:milk . :bowl)))
  (<- (pourable (:breakfast-cereal . :bowl)))

  (<- (other-arm :left :right))
  (<- (other-arm :right :left)))

(def-fact-group pour-designators (desig:action-grounding)

  (<- (desig:action-grounding ?action-designator (pour ?resolved-action-designator))
    (spec:property ?action-designator (:type :pouring))
    (rob-int:robot ?robot)
    ;; from
    (spec:property ?action-designator (:source-object ?some-source))
    (desig:current-designator ?some-source ?source)
    (spec:property ?source (:type ?source-type))
    (spec:property ?source (:location ?source-location))
    ;; into
    (spec:property ?action-designator (:target-object ?some-target))
    (desig:current-designator ?some-target ?target)
    (spec:property ?target (:type ?target-type))
    (spec:property ?target (:location ?target-location))
    (pourable (?source-type . ?target-type))
    ;; arms: two different ones
    (-> (spec:property ?action-designator (:arm ?source-arm))
        (true)
        (rob-int:arm ?robot ?source-arm))
    (other-arm ?source-arm ?target-arm)
    (rob-int:arm-name ?source-arm ?name)
    (format "pouring with ~a~%" ?name)
    ;; the way down
    (desig:designator-groundings ?target-location (?target-pose . ?_))
    (lisp-fun pouring-poses ?target-pose :steps 4 ?poses)
    (desig:designator :action ((:type :pouring)
                               (:source ?source)
                               (:target ?target)
                               (:source-location ?source-location)
                               (:target-location ?target-location)
                               (:source-arm ?source-arm)
                               (:target-arm ?target-arm)
                               (:poses ?poses))
                      ?resolved-action-designator)))
