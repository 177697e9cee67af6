"""The paper's other modules: database, visual, audio and social media. They know the exhibition by the bus alone."""
