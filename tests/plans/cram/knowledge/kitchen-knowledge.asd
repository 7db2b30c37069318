(defsystem kitchen-knowledge
  :author "the kitchen's people"
  :license "MIT"
  :description "What the plans may ask about the robot, its kitchen and the objects in it."
  :depends-on (cram-language cram-designators cram-prolog cl-transforms cl-transforms-stamped)
  :serial t
  :components ((:file "package")
               (:file "robot")
               (:file "places")
               (:file "objects")))
