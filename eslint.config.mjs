// The rules for the code of the console's pages: `tests/features/console/test_page_sources.py` checks them with what it
// fetches, and an editor finds this file by itself.
import js from "./.cache/eslint/node_modules/@eslint/js/src/index.js";
import globals from "./.cache/eslint/node_modules/globals/index.js";

export default [
  { ignores: ["**/vendor/**", "**/*.d.ts"] },
  js.configs.recommended,
  {
    files: ["engine/lumen/features/console/pages/**/*.js", "tests/features/console/examples/*.js"],
    languageOptions: { globals: { ...globals.browser, lumen: "readonly" }, sourceType: "module" },
    linterOptions: { reportUnusedDisableDirectives: "error" },
    rules: {
      eqeqeq: ["error", "always", { null: "ignore" }], // `== null` means null or undefined
      "array-callback-return": "error",
      "consistent-return": "error",
      "default-case-last": "error",
      "no-constant-binary-expression": "error",
      "no-constructor-return": "error",
      "no-duplicate-imports": "error",
      "no-eval": "error",
      "no-implicit-coercion": "error",
      "no-implicit-globals": "error",
      "no-implied-eval": "error",
      "no-new-wrappers": "error",
      "no-promise-executor-return": "error",
      "no-return-assign": "error",
      "no-self-compare": "error",
      "no-sequences": "error",
      "no-shadow": ["error", { builtinGlobals: false }],
      "no-template-curly-in-string": "error",
      "no-throw-literal": "error",
      "no-unmodified-loop-condition": "error",
      "no-unreachable-loop": "error",
      "no-unused-expressions": "error",
      "no-unused-vars": ["error", { argsIgnorePattern: "^_" }],
      "no-useless-rename": "error",
      "no-var": "error",
      "object-shorthand": "error",
      "prefer-const": ["error", { destructuring: "all" }],
      "require-atomic-updates": "error",
    },
  },
  { files: ["**/pages/rest.js"], languageOptions: { sourceType: "script" } },
];
