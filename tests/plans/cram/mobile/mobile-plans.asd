(defsystem mobile-plans
  :author "the kitchen's people"
  :license "MIT"
  :description "Plans of a robot that drives about and handles one thing at a time."
  :depends-on (cram-language cram-executive cram-designators cram-prolog
               cram-common-failures kitchen-knowledge)
  :components
  ((:module "src"
    :components
    ((:file "package")
     (:file "events" :depends-on ("package"))
     (:file "atomic-plans" :depends-on ("package" "events"))
     (:file "atomic-designators" :depends-on ("package" "atomic-plans"))))))
