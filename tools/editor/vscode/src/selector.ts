// Which documents the language server is told of.

/** Plans are not listed by language, since other extensions give Lisp files theirs. */
export const selector: { scheme: 'file'; language?: string; pattern?: string }[] = [
  { scheme: 'file', language: 'dec' },
  { scheme: 'file', language: 'dec-bind' },
  { scheme: 'file', language: 'yaml' },
  { scheme: 'file', pattern: '**/*.lisp' },
];

/** Files whose change on the disk may change messages. */
export const watched = '**/*.{e,bind,yaml,yml,lisp}';
